// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Runs an .mlx script on a mesh with the library of a built MeshLab, as its window does, and
/// saves the layer that is current in the end: run_script IO_BASE PLUGIN SCRIPT MESH OUTPUT...

#include <common/filterscript.h>
#include <common/globals.h>
#include <common/ml_document/mesh_document.h>
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>
#include <common/utilities/load_save.h>

#include <QApplication>

#include <cstdio>

namespace {

void runScript(const QString& file, MeshDocument& document, GLLogStream& log)
{
	PluginManager& plugins = meshlab::pluginManagerInstance();
	FilterScript script;
	if (!script.open(file))
		throw MLException("cannot read " + file);
	for (const FilterNameParameterValuesPair& step : script) {
		QAction* action = plugins.filterAction(step.filterName());
		if (!action)
			throw MLException("no filter " + step.filterName());
		FilterPlugin* filter = plugins.getFilterPluginFromAction(action);
		filter->setLog(&log);
		RichParameterList parameters = filter->initParameterList(action, document);
		for (const RichParameter& given : step.second)
			parameters.setValue(given.name(), given.value());
		unsigned int changed = 0;
		filter->applyFilter(action, parameters, document, changed, nullptr);
	}
}

} // namespace

int main(int argc, char** argv)
{
	qputenv("QT_QPA_PLATFORM", "offscreen");
	QApplication application(argc, argv);
	const QStringList arguments = application.arguments();
	if (arguments.size() < 6)
		return 2;
	GLLogStream log;
	try {
		MeshDocument document;
		for (int i : {1, 2})
			meshlab::pluginManagerInstance().loadPlugin(arguments[i]);
		meshlab::loadMeshWithStandardParameters(arguments[4], document);
		runScript(arguments[3], document, log);
		for (const QString& output : arguments.mid(5))
			meshlab::saveMeshWithStandardParameters(output, *document.mm(), &log);
	}
	catch (const MLException& error) {
		std::fprintf(stderr, "%s\n", error.what());
		return 1;
	}
	return 0;
}
