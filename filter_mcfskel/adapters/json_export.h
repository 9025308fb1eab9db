// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Skeletons as JSON through the host's own export. Every host has a JSON exporter, which writes
/// no edges, and its registry knows one exporter for each extension: the one that was loaded first.

#ifndef MCFSKEL_JSON_EXPORT_H
#define MCFSKEL_JSON_EXPORT_H

#include "../host/host_api.h"

namespace mcfskel::host {

/**
 * While it lives, the host takes `plugin` for the exporter of `.json`, and `plugin` knows the one that
 * it stands in front of, for all layers that are no skeletons.
 *
 * The registry keeps its table private and offers no way to change an entry, other than to unload the
 * host's own plugin; so the entry is changed through a pointer to the private member.
 */
class JsonExport
{
public:
	explicit JsonExport(IOPlugin* plugin);

	/// Puts the host's exporter back.
	~JsonExport();

	JsonExport(const JsonExport&) = delete;
	JsonExport& operator=(const JsonExport&) = delete;

	/// Steps in front of the host's exporter, if that is there by now; may be called again and again.
	void claim();

	/// The host's exporter, where it is the one to deal with this format; else null.
	IOPlugin* exporterOf(const QString& format) const;

	/// The host's exporter, where it is the one to write this layer; else null.
	IOPlugin* exporterOf(const QString& format, const MeshModel& layer) const;

private:
	IOPlugin* plugin_;
	/// The host's; never used once the host has dropped it, since it then drops `.json` as well.
	IOPlugin* other_ = nullptr;
};

} // namespace mcfskel::host

#endif
