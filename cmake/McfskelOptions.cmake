# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# mcfskel_options: how the project's own code is compiled, wherever it ends up.

add_library(mcfskel_options INTERFACE)
target_compile_features(mcfskel_options INTERFACE cxx_std_17)
target_compile_options(mcfskel_options INTERFACE
	-Wall -Wextra
	# Contracted operations would make the results depend on the processor.
	-ffp-contract=off)
if(MCFSKEL_SANITIZE)
	target_compile_options(mcfskel_options INTERFACE
		-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
	target_link_options(mcfskel_options INTERFACE -fsanitize=address,undefined)
endif()
