# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# mcfskel_options: how this project's own code is compiled, beside what the library asks for.

add_library(mcfskel_options INTERFACE)
target_compile_options(mcfskel_options INTERFACE -Wall -Wextra)
if(MCFSKEL_SANITIZE)
	target_compile_options(mcfskel_options INTERFACE
		-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
	target_link_options(mcfskel_options INTERFACE -fsanitize=address,undefined)
endif()
