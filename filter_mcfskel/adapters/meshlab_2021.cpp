// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshlab_2021.h"

#if MCFSKEL_FILES
#include "../io/formats.h"
#endif
#include "translate.h"

#if MCFSKEL_PYTHON_HOST
#include "pymeshlab_log.h"

#include <common/globals.h>
#include <common/python/function_set.h>
#endif

using namespace mcfskel;

#if !MCFSKEL_IN_MESHLAB
namespace {

/// pymeshlab.load_plugin() registers the formats of a plugin only if it has no filters.
void registerFormats([[maybe_unused]] IOPlugin* plugin)
{
#if MCFSKEL_PYTHON_HOST
	// While pymeshlab loads its own plugins at start the registry must not be touched: it is built
	// from them afterwards, including the formats of this plugin.
	if (meshlab::pluginManagerInstance().isInputMeshFormatSupported("ply"))
		pymeshlab::functionSetInstance().loadIOPlugin(plugin);
#endif
}

} // namespace
#endif

FilterMcfskelPlugin::FilterMcfskelPlugin()
{
#if !MCFSKEL_IN_MESHLAB
	registerFormats(this);
#endif
	for (int id = 0; id < int(catalogue().size()); ++id) {
		typeList.push_back(id);
		actionList.push_back(new QAction(filterName(id), this));
	}
}

QString FilterMcfskelPlugin::pluginName() const
{
	return "FilterMcfskel";
}

QString FilterMcfskelPlugin::vendor() const
{
	return "Mean Curvature Skeletons contributors";
}

QString FilterMcfskelPlugin::filterName(ActionIDType id) const
{
	return host::filterOf(id).menuName;
}

QString FilterMcfskelPlugin::pythonFilterName(ActionIDType id) const
{
	return host::filterOf(id).pythonName;
}

QString FilterMcfskelPlugin::filterInfo(ActionIDType id) const
{
	return host::filterOf(id).help;
}

FilterPlugin::FilterClass FilterMcfskelPlugin::getClass(const QAction* action) const
{
	return host::filterClass(host::filterOf(ID(action)));
}

FilterPlugin::FilterArity FilterMcfskelPlugin::filterArity(const QAction* action) const
{
	return host::filterOf(ID(action)).needsLayer ? SINGLE_MESH : NONE;
}

int FilterMcfskelPlugin::getPreConditions(const QAction* action) const
{
	return host::filterOf(ID(action)).preConditions;
}

int FilterMcfskelPlugin::postCondition(const QAction* action) const
{
	return host::filterOf(ID(action)).changes;
}

RichParameterList FilterMcfskelPlugin::initParameterList(
	const QAction* action, const MeshDocument& document)
{
	RichParameterList list;
	host::addParameters(list, host::filterOf(ID(action)), document);
	return list;
}

std::map<std::string, QVariant> FilterMcfskelPlugin::applyFilter(const QAction* action,
	const RichParameterList& parameters, MeshDocument& document, unsigned int&,
	vcg::CallBackPos* callback)
{
#if MCFSKEL_PYTHON_HOST
	host::PymeshlabLog hostLog(*this, document, callback);
	const auto progress = [&hostLog](int percent, const char* what) {
		return hostLog.progress(percent, what);
	};
#else
	const auto progress = callback;
#endif
	const FilterSpec& filter = host::filterOf(ID(action));
	const auto values = [&] { return host::readParameters(parameters, filter, document); };
	const Outcome outcome = runFilter(
		filter, document, values, [this](const QString& line) { log(line.toStdString()); },
		progress);
	if (!outcome.error.isEmpty())
		throw MLException(outcome.error);
	return outcome.results;
}

#if MCFSKEL_FILES
namespace {

std::list<FileFormat> fileFormats(bool (SkeletonFormat::*possible)() const)
{
	std::list<FileFormat> formats;
	for (const SkeletonFormat& format : skeletonFormats())
		if ((format.*possible)())
			formats.emplace_back(format.description, format.extension);
	return formats;
}

} // namespace

std::list<FileFormat> FilterMcfskelPlugin::importFormats() const
{
	return fileFormats(&SkeletonFormat::isRead);
}

std::list<FileFormat> FilterMcfskelPlugin::exportFormats() const
{
	return fileFormats(&SkeletonFormat::isWritten);
}

void FilterMcfskelPlugin::exportMaskCapability(
	const QString&, int& capability, int& defaultBits) const
{
	capability = defaultBits = writtenElements;
}

void FilterMcfskelPlugin::fail(const QString& error)
{
	// A verbose host leaves the plugin a pointer to the log of a document that may be deleted.
	setLog(nullptr);
	throw MLException(error);
}

void FilterMcfskelPlugin::open(const QString&, const QString& file, MeshModel& layer, int& mask,
	const RichParameterList&, vcg::CallBackPos*)
{
	const FileOutcome outcome = openSkeleton(file, layer);
	mask = outcome.mask;
	for (const QString& warning : outcome.warnings)
		log(GLLogStream::WARNING, warning.toStdString());
	if (!outcome.error.isEmpty())
		fail(outcome.error);
}

void FilterMcfskelPlugin::save(const QString&, const QString& file, MeshModel& layer, const int,
	const RichParameterList&, vcg::CallBackPos*)
{
	const FileOutcome outcome = saveSkeleton(file, layer);
	for (const QString& warning : outcome.warnings)
		log(GLLogStream::WARNING, warning.toStdString());
	if (!outcome.error.isEmpty())
		fail(outcome.error);
}
#endif

MESHLAB_PLUGIN_NAME_EXPORTER(FilterMcfskelPlugin)
