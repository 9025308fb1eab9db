// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Runs an .mlx script on a mesh with the library of a built MeshLab, as its window does, and
/// saves the layer that is current in the end: run_script IO_BASE PLUGIN SCRIPT MESH OUTPUT...
/// With --cancel in place of the outputs each filter is first cancelled at its first report of progress,
/// then at its second, and so on, until it comes to its end; from the 200th on it is at reports further and
/// further apart, by chance. A document, or a file to write, that a cancelled filter has changed is an error.
/// The number of cancellings is printed. A layer as a parameter is then counted from the last one, which is 0,
/// since the numbers of layers depend on how often filters were cancelled.

#include <common/filterscript.h>
#include <common/globals.h>
#include <common/ml_document/mesh_document.h>
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>
#include <common/utilities/load_save.h>

#include <QApplication>
#include <QDirIterator>
#include <QFile>
#include <QFileInfo>

#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// All that a cancelled filter must leave as it was.
std::string contents(const MeshDocument& document)
{
	std::string text = "current " + std::to_string(document.mm()->id());
	for (const MeshModel& layer : document.meshIterator()) {
		const CMeshO& mesh = layer.cm;
		std::uint64_t hash = 0;
		const auto add = [&](const void* begin, size_t size) {
			const std::string_view bytes(static_cast<const char*>(begin), size);
			hash = hash * 31 + std::hash<std::string_view>()(bytes);
		};
		for (const CVertexO& v : mesh.vert) {
			add(&v.cP(), sizeof v.cP());
			add(&v.cN(), sizeof v.cN());
			if (layer.hasDataMask(MeshModel::MM_VERTQUALITY))
				add(&v.cQ(), sizeof v.cQ());
			if (layer.hasDataMask(MeshModel::MM_VERTCOLOR))
				add(&v.cC(), sizeof v.cC());
		}
		for (const CFaceO& f : mesh.face)
			if (layer.hasDataMask(MeshModel::MM_FACEQUALITY))
				add(&f.cQ(), sizeof f.cQ());
		text += "; " + layer.label().toStdString() + ' ' + std::to_string(mesh.vn) + ' '
			+ std::to_string(mesh.en) + ' ' + std::to_string(mesh.fn) + " visible "
			+ std::to_string(layer.isVisible());
		for (const vcg::PointerToAttribute& attribute : mesh.vert_attr) {
			add(attribute._handle->DataBegin(), mesh.vert.size() * size_t(attribute._sizeof));
			text += ' ' + attribute._name;
		}
		text += ' ' + std::to_string(hash);
	}
	return text;
}

std::string fileContents(const QString& path)
{
	QFile file(path);
	return file.open(QIODevice::ReadOnly) ? file.readAll().toStdString() : "none";
}

/// What is in the folder that a step writes a file to, and in those below, if it writes one.
std::string fileContents(const FilterNameParameterValuesPair& step)
{
	QStringList found;
	for (const RichParameter& given : step.second)
		if (given.name() == "file") {
			const QString folder = QFileInfo(given.value().getString()).path();
			QDirIterator all(folder, QDir::AllEntries | QDir::Hidden | QDir::NoDotAndDotDot,
				QDirIterator::Subdirectories);
			while (all.hasNext())
				found.push_back(all.next());
		}
	found.sort();
	std::string text;
	for (const QString& path : found)
		text += "; " + path.toStdString() + ' ' + fileContents(path);
	return text;
}

/// The number of a layer that is counted from the last one.
int layerFromLast(const MeshDocument& document, int count)
{
	std::vector<int> ids;
	for (const MeshModel& layer : document.meshIterator())
		ids.push_back(int(layer.id()));
	if (count < 0 || count >= int(ids.size()))
		throw MLException("no layer " + QString::number(count) + " from the last");
	return ids[ids.size() - 1 - size_t(count)];
}

/// The reports that are left until a filter is cancelled; none: it is not.
int reportsLeft = 0;

bool report(const int, const char*)
{
	return reportsLeft == 0 || --reportsLeft > 0;
}

void runScript(const QString& file, MeshDocument& document, GLLogStream& log, bool cancelling)
{
	PluginManager& plugins = meshlab::pluginManagerInstance();
	FilterScript script;
	if (!script.open(file))
		throw MLException("cannot read " + file);
	std::mt19937 random;
	for (const FilterNameParameterValuesPair& step : script) {
		QAction* action = plugins.filterAction(step.filterName());
		if (!action)
			throw MLException("no filter " + step.filterName());
		FilterPlugin* filter = plugins.getFilterPluginFromAction(action);
		filter->setLog(&log);
		RichParameterList parameters = filter->initParameterList(action, document);
		for (const RichParameter& given : step.second)
			if (cancelling && given.stringType() == "RichMesh")
				parameters.setValue(
					given.name(), IntValue(layerFromLast(document, given.value().getInt())));
			else
				parameters.setValue(given.name(), given.value());
		unsigned int changed = 0;
		const std::string before = contents(document) + fileContents(step);
		int cancelled = 0, at = 0;
		for (bool done = false; !done;) {
			at += at < 200 ? 1 : 1 + int(random() % unsigned(at / 50));
			reportsLeft = cancelling ? at : 0;
			try {
				filter->applyFilter(action, parameters, document, changed, report);
				done = true;
			}
			catch (const MLException& error) {
				if (reportsLeft > 0 || !QString(error.what()).startsWith("Cancelled"))
					throw;
				if (contents(document) + fileContents(step) != before)
					throw MLException(
						QString("%1, cancelled at its report %2, has changed something")
							.arg(step.filterName())
							.arg(at));
				++cancelled;
			}
		}
		if (cancelling)
			std::printf("%s: %d\n", qPrintable(step.filterName()), cancelled);
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
		const bool cancelling = arguments[5] == "--cancel";
		runScript(arguments[3], document, log, cancelling);
		for (const QString& output : cancelling ? QStringList() : arguments.mid(5))
			meshlab::saveMeshWithStandardParameters(output, *document.mm(), &log);
	}
	catch (const MLException& error) {
		std::fprintf(stderr, "%s\n", error.what());
		return 1;
	}
	return 0;
}
