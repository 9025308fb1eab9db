# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# vcg: the headers of VCG, from VCG_INCLUDE_DIR.

find_path(VCG_INCLUDE_DIR vcg/complex/complex.h
	HINTS "${MESHLAB_SRC}/src/vcglib" "${MESHLAB_SRC}/vcglib"
	DOC "The folder of vcglib, with vcg/ and wrap/ in it")
if(NOT VCG_INCLUDE_DIR)
	message(FATAL_ERROR "No headers of VCG: set VCG_INCLUDE_DIR to the folder of vcglib")
elseif(NOT EXISTS "${VCG_INCLUDE_DIR}/vcg/complex/complex.h")
	message(FATAL_ERROR "No headers of VCG in '${VCG_INCLUDE_DIR}': set VCG_INCLUDE_DIR to the folder of vcglib")
endif()

add_library(vcg INTERFACE)
# SYSTEM: VCG's own warnings are not ours to mend.
target_include_directories(vcg SYSTEM INTERFACE "${VCG_INCLUDE_DIR}")
