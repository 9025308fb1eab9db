// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief pymeshlab's log while one of the plugin's filters runs: what pymeshlab leaves undone when a
/// filter fails, and when several run at once.

#ifndef MCFSKEL_PYMESHLAB_LOG_H
#define MCFSKEL_PYMESHLAB_LOG_H

#include "../host/host_api.h"

namespace mcfskel::host {

/**
 * Made where a filter begins, destroyed where it ends.
 *
 * pymeshlab's progress callback logs through a static pointer to the log of the document whose filter
 * began last. The pointer is set to null after a filter only if the filter succeeded: after one that
 * failed, the next callback, as from load_new_mesh() into another document, writes into that document,
 * which may be gone (applyFilterRPL() in PyMeshLab's meshset_helper.cpp, 2022.2 to 2025.7). So this sets
 * it to null where an exception leaves the filter. The module exports no symbol for the pointer: it is
 * the one word of the module's static memory that holds the address of the document's log. Nor does
 * pymeshlab undo the redirection into nowhere of std::cout, std::cerr and Qt's messages, and everything
 * that it prints later is lost: they are put back, too.
 *
 * The same happens where two filters run in two threads, both logging into the document of one of them,
 * without a lock. Filters of this plugin take turns in calling back, and of those that run at once none
 * leaves a pointer to its document behind.
 *
 * The lines that a filter has logged are removed from the document in the end: a script cannot read them
 * there, and nothing else ever removes them, not even clear(). Where pymeshlab prints its log, it has
 * printed them by then.
 */
class PymeshlabLog
{
public:
	PymeshlabLog(MeshLabPluginLogger& plugin, MeshDocument& document, vcg::CallBackPos* callback);
	~PymeshlabLog();
	PymeshlabLog(const PymeshlabLog&) = delete;
	PymeshlabLog& operator=(const PymeshlabLog&) = delete;

	/// Calls back; false: the user has cancelled.
	bool progress(int percent, const char* what);

private:
	MeshLabPluginLogger& plugin;
	GLLogStream& log;
	vcg::CallBackPos* callback;
	int exceptions;
};

} // namespace mcfskel::host

#endif
