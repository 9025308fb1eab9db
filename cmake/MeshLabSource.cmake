# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# vcg: the headers of VCG, from the MeshLab source tree in MESHLAB_SRC.

set(MESHLAB_SRC_HELP
	"set MESHLAB_SRC to the source tree of a MeshLab release, or run scripts/build.sh, which gets one")
if(NOT EXISTS "${MESHLAB_SRC}/src/common/mlexception.h")
	message(FATAL_ERROR "No MeshLab headers in '${MESHLAB_SRC}': ${MESHLAB_SRC_HELP}")
endif()

find_path(VCG_INCLUDE_DIR vcg/complex/complex.h
	PATHS "${MESHLAB_SRC}/src/vcglib" "${MESHLAB_SRC}/vcglib" NO_DEFAULT_PATH REQUIRED)

add_library(vcg INTERFACE)
# SYSTEM: VCG's own warnings are not ours to mend.
target_include_directories(vcg SYSTEM INTERFACE "${VCG_INCLUDE_DIR}")
