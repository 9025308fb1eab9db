# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# mcfskel_options: how this project's own code is compiled, beside what the library asks for.

add_library(mcfskel_options INTERFACE)
target_compile_options(mcfskel_options INTERFACE -Wall -Wextra)
if(MCFSKEL_SANITIZE STREQUAL "address")
	set(sanitizers address,undefined)
	if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
		# Conversions of numbers beyond an integer's range are not among `undefined`.
		string(APPEND sanitizers ,float-cast-overflow)
	endif()
elseif(MCFSKEL_SANITIZE STREQUAL "thread")
	set(sanitizers thread)
elseif(MCFSKEL_SANITIZE)
	message(FATAL_ERROR "MCFSKEL_SANITIZE is '${MCFSKEL_SANITIZE}': address or thread")
endif()
if(sanitizers)
	target_compile_options(mcfskel_options INTERFACE
		-fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
	target_link_options(mcfskel_options INTERFACE -fsanitize=${sanitizers})
endif()
