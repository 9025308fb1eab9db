# SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
# SPDX-License-Identifier: GPL-3.0-or-later
#
# qhull: the reentrant Qhull as a static library that can become part of a plugin, so that the plugin
# is one file and asks nothing of its host.
#
# Debian compiles its static library for programs: it reaches libc's stdin, stdout and stderr in a way
# that a shared library must not. Those three references, and nothing else, are sent to variables of
# our own.

find_package(Qhull REQUIRED NO_MODULE)
find_program(OBJCOPY NAMES ${CMAKE_OBJCOPY} objcopy REQUIRED)

set(qhull_archive "${CMAKE_BINARY_DIR}/qhull/libqhull_plugin.a")
file(WRITE "${CMAKE_BINARY_DIR}/qhull/streams.c.in" [[
#include <stdio.h>
#define STREAM(name) __attribute__((visibility("hidden"))) FILE* mcfskel_##name
STREAM(stdin);
STREAM(stdout);
STREAM(stderr);
__attribute__((constructor)) static void openStreams(void)
{
	mcfskel_stdin = stdin;
	mcfskel_stdout = stdout;
	mcfskel_stderr = stderr;
}
]])
configure_file("${CMAKE_BINARY_DIR}/qhull/streams.c.in" "${CMAKE_BINARY_DIR}/qhull/streams.c" COPYONLY)

add_custom_command(OUTPUT "${qhull_archive}"
	COMMAND "${OBJCOPY}"
		--redefine-sym stdin=mcfskel_stdin
		--redefine-sym stdout=mcfskel_stdout
		--redefine-sym stderr=mcfskel_stderr
		"$<TARGET_FILE:Qhull::qhullstatic_r>" "${qhull_archive}"
	DEPENDS Qhull::qhullstatic_r VERBATIM)
add_custom_target(qhull_archive DEPENDS "${qhull_archive}")

get_target_property(qhull_include Qhull::qhullstatic_r INTERFACE_INCLUDE_DIRECTORIES)

add_library(qhull INTERFACE)
add_dependencies(qhull qhull_archive)
target_include_directories(qhull SYSTEM INTERFACE "${qhull_include}")
# As a source: a constructor in an archive, in a member that nobody names, would not be linked.
target_sources(qhull INTERFACE "${CMAKE_BINARY_DIR}/qhull/streams.c")
target_link_libraries(qhull INTERFACE "${qhull_archive}" m)
