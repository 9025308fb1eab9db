# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# meshlab_host: what a plugin for MESHLAB_HOST is compiled and linked with. A host loads a plugin only
# if scalar precision and version are its own.

if(MESHLAB_HOST STREQUAL "pymeshlab")
	set(MESHLAB_SCALAR double)
	set(MESHLAB_VERSION 2025.07)
elseif(MESHLAB_HOST MATCHES "^pymeshlab-([0-9]+\\.[0-9]+)$")
	set(MESHLAB_SCALAR double)
	# A wheel's version drops the month's leading zero.
	string(REGEX REPLACE "\\.([0-9])$" ".0\\1" MESHLAB_VERSION "${CMAKE_MATCH_1}")
elseif(MESHLAB_HOST MATCHES "^meshlab-([0-9]+\\.[0-9]+)$")
	set(MESHLAB_SCALAR float)
	set(MESHLAB_VERSION ${CMAKE_MATCH_1})
else()
	message(FATAL_ERROR "Unknown MESHLAB_HOST '${MESHLAB_HOST}'")
endif()

# The plugin interface has had two ages: MeshFilterInterface, and FilterPlugin since 2021.05.
if(MESHLAB_VERSION VERSION_LESS 2021.05)
	set(MESHLAB_API 2020)
else()
	set(MESHLAB_API 2021)
endif()

# Four classes of parameters changed their names with 2023.12.
if(MESHLAB_VERSION VERSION_LESS 2023.12)
	set(renamed_parameters 0)
else()
	set(renamed_parameters 1)
endif()

set(host_header_2020 common/interfaces.h)
set(host_header_2021 common/plugins/interfaces/filter_plugin.h)
if(NOT EXISTS "${MESHLAB_SRC}/src/${host_header_${MESHLAB_API}}")
	message(FATAL_ERROR "'${MESHLAB_SRC}' is no source tree of MeshLab ${MESHLAB_VERSION}: "
		"${MESHLAB_SRC_HELP}")
endif()

find_package(Qt5 5.9 REQUIRED COMPONENTS Core Gui Widgets OpenGL Xml)
find_path(GLEW_INCLUDE_DIR GL/glew.h REQUIRED)

# A plugin takes MeshLab's functions from the library that its host has already loaded. An empty
# library of the same name is enough to link against, so that nobody needs to build MeshLab first.
file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/stub/meshlab_common.c" CONTENT "")  # keeps its date
add_library(meshlab_common_stub SHARED "${CMAKE_BINARY_DIR}/stub/meshlab_common.c")
set_target_properties(meshlab_common_stub PROPERTIES
	OUTPUT_NAME meshlab-common
	LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/stub")

add_library(meshlab_host INTERFACE)
target_include_directories(meshlab_host SYSTEM INTERFACE "${MESHLAB_SRC}/src" "${GLEW_INCLUDE_DIR}")
target_compile_definitions(meshlab_host INTERFACE
	MESHLAB_SCALAR=${MESHLAB_SCALAR}
	# A target may be for another release with the same interface.
	MESHLAB_VERSION=$<IF:$<BOOL:$<TARGET_PROPERTY:HOST_RELEASE>>,$<TARGET_PROPERTY:HOST_RELEASE>,${MESHLAB_VERSION}>
	MCFSKEL_HOST_API=${MESHLAB_API}
	# Of these three, scripts/upstream.sh makes patches with other values.
	MCFSKEL_IN_MESHLAB=0
	MCFSKEL_FILES=1
	MCFSKEL_SHEETS=1
	MCFSKEL_RENAMED_PARAMETERS=${renamed_parameters}
	MCFSKEL_PYTHON_HOST=$<STREQUAL:${MESHLAB_SCALAR},double>)
target_link_libraries(meshlab_host INTERFACE
	vcg -Wl,--no-as-needed meshlab_common_stub -Wl,--as-needed
	Qt5::Core Qt5::Gui Qt5::Widgets Qt5::OpenGL Qt5::Xml)
