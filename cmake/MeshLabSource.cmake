# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The MeshLab source tree in MESHLAB_SRC, which has the headers of VCG, too.

set(MESHLAB_SRC_HELP
	"set MESHLAB_SRC to the source tree of a MeshLab release, or run scripts/build.sh, which gets one")
if(NOT EXISTS "${MESHLAB_SRC}/src/common/mlexception.h")
	message(FATAL_ERROR "No MeshLab headers in '${MESHLAB_SRC}': ${MESHLAB_SRC_HELP}; the library "
		"alone needs none: -DMCFSKEL_PLUGIN=OFF")
endif()

# The plugin shares meshes with its host: no other VCG will do, and none of an earlier MESHLAB_SRC.
unset(VCG_INCLUDE_DIR CACHE)
find_path(VCG_INCLUDE_DIR vcg/complex/complex.h
	PATHS "${MESHLAB_SRC}/src/vcglib" "${MESHLAB_SRC}/vcglib" NO_DEFAULT_PATH REQUIRED)
