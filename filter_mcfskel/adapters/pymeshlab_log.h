// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief pymeshlab's log while one of the plugin's filters runs: what pymeshlab fails to clean up
/// when a filter fails, and when several run at once.

#ifndef MCFSKEL_PYMESHLAB_LOG_H
#define MCFSKEL_PYMESHLAB_LOG_H

#include "../host/host_api.h"

namespace mcfskel::host {

/**
 * Constructed where a filter begins, destroyed where it ends.
 *
 * pymeshlab's progress callback logs through a static pointer to the log of the document whose
 * filter began last. pymeshlab resets the pointer to null only if the filter succeeds. After a
 * failure the next callback, such as that of load_new_mesh() into another document, writes into the
 * first one, which may be gone (applyFilterRPL() in PyMeshLab's meshset_helper.cpp, 2022.2 to
 * 2025.7). So the destructor resets it where an exception leaves the filter. The module exports no
 * symbol for the pointer: it is the one word of the module's static memory that holds the address
 * of the document's log. Nor does pymeshlab undo its redirection of std::cout, std::cerr and Qt's
 * messages into nowhere, so that all later output would be lost: the destructor restores them, too.
 *
 * The pointer is also wrong if filters run in two threads: both log into the document of one of
 * them, without a lock. Filters of this plugin take turns in calling back, and none of those that
 * run at once leaves a pointer to its document behind.
 *
 * The lines that a filter has logged are removed from the document at its end: a script cannot read
 * them there, and nothing else ever removes them, not even clear(). Where pymeshlab prints its log,
 * it has printed them by then.
 */
class PymeshlabLog
{
public:
	PymeshlabLog(MeshLabPluginLogger& plugin, MeshDocument& document, vcg::CallBackPos* callback);
	~PymeshlabLog();
	PymeshlabLog(const PymeshlabLog&) = delete;
	PymeshlabLog& operator=(const PymeshlabLog&) = delete;

	/// Calls back; false if the user has cancelled.
	bool progress(int percent, const char* what);

private:
	MeshLabPluginLogger& plugin;
	GLLogStream& log;
	vcg::CallBackPos* callback;
	int exceptions;
};

} // namespace mcfskel::host

#endif
