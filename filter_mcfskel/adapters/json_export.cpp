// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "json_export.h"

#include <common/globals.h>
#include <common/plugins/plugin_manager.h>

namespace mcfskel::host {

namespace {

/// Gives the private member that an explicit instantiation names, for which the language makes an
/// exception from access control.
template <class Name, typename Name::Member member>
struct Grant
{
	friend typename Name::Member memberOf(Name) { return member; }
};

struct Containers
{
	using Member = IOPluginContainer PluginManager::*;
	friend Member memberOf(Containers);
};
template struct Grant<Containers, &PluginManager::ioPlugins>;

struct Exporters
{
	using Member = QMap<QString, IOPlugin*> IOPluginContainer::*;
	friend Member memberOf(Exporters);
};
template struct Grant<Exporters, &IOPluginContainer::outputMeshFormatToPluginMap>;

/// No object, which might be gone when the host takes its plugins down.
constexpr QLatin1String json("json");

/// By extension, in lower case.
QMap<QString, IOPlugin*>& exporters()
{
	return meshlab::pluginManagerInstance().*memberOf(Containers()).*memberOf(Exporters());
}

} // namespace

JsonExport::JsonExport(IOPlugin* plugin) : plugin_(plugin)
{
	claim();
}

JsonExport::~JsonExport()
{
	const auto entry = exporters().find(QString(json));
	if (entry != exporters().end() && *entry == plugin_)
		*entry = other_;
}

void JsonExport::claim()
{
	const auto entry = exporters().find(QString(json));
	if (entry == exporters().end() || *entry == plugin_)
		return;
	other_ = *entry;
	*entry = plugin_;
}

IOPlugin* JsonExport::exporterOf(const QString& format) const
{
	return format.compare(json, Qt::CaseInsensitive) == 0 ? other_ : nullptr;
}

IOPlugin* JsonExport::exporterOf(const QString& format, const MeshModel& layer) const
{
	return layer.cm.fn > 0 || layer.cm.en == 0 ? exporterOf(format) : nullptr;
}

} // namespace mcfskel::host
