// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "../host/scene.h"
#include "../io/files.h"
#include "../io/layer_files.h"
#include "all_filters.h"
#include "filter_support.h"

#include <skeleton/skeleton_files.h>
#include <skeleton/support.h>

#include <QDir>
#include <QFileInfo>
#include <QRegularExpression>
#include <QSet>
#include <QXmlStreamWriter>

#include <algorithm>
#include <optional>
#include <ostream>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// A layer, what is known of it, and where it goes.
struct SavedLayer
{
	LayerAsRead layer;
	StageLayer stage;
	std::shared_ptr<const CurveLayer> curve;
	QString path; ///< from the project's folder
};

/// A name for a layer's file, unique even on systems that ignore case.
QString fileName(const MeshModel& layer, QSet<QString>& taken)
{
	static const QRegularExpression notPortable("[^\\w ().+-]");
	QString name = QFileInfo(layer.label()).completeBaseName();
	name.replace(notPortable, "_");
	if (name.isEmpty())
		name = "layer";
	QString unique = name;
	for (int k = 1; taken.contains(unique.toLower()); ++k)
		unique = QString("%1(%2)").arg(name).arg(k);
	taken.insert(unique.toLower());
	return unique + ".ply";
}

/// Reads what is known of a layer, and says so if nothing is any more. One that is no valid stage or
/// skeleton is an ordinary mesh, so that all the others can be saved.
void takeState(const FilterRun& run, const MeshModel& layer, SavedLayer& item)
{
	try {
		if (layer.cm.fn > 0)
			item.stage = readStage(layer, sourcesOf(run));
		else if (layer.cm.en > 0) {
			auto curve = std::make_shared<const CurveLayer>(readCurve(layer, sourcesOf(run)));
			mcf::requireWritable(curve->skeleton);
			item.curve = std::move(curve);
		}
		if (!item.stage && !item.curve)
			if (const QString lost = lostState(layer); !lost.isEmpty())
				run.log(lost);
	}
	catch (const mcf::Error& error) {
		run.log("The layer '" + layer.label()
			+ "' is saved as a mesh, without what the filters know of it. " + error.what());
	}
}

/// The layers, all read before any file is written: it may hold the state of another layer.
std::vector<SavedLayer> layersToSave(const FilterRun& run, const QString& folder)
{
	std::vector<SavedLayer> saved;
	QSet<QString> taken;
	for (const MeshModel* found : host::layersOf(run.document)) {
		const MeshModel& layer = *found;
		SavedLayer item {LayerAsRead(layer), {}, nullptr, folder + "/" + fileName(layer, taken)};
		takeState(run, layer, item);
		if (!layer.cm.textures.empty())
			run.log("The textures of '" + layer.label() + "' are not saved.");
		saved.push_back(std::move(item));
	}
	return saved;
}

void writeLayer(MeshDocument& document, const SavedLayer& saved, const QDir& place,
	const mcf::Progress& progress)
{
	const MeshModel& layer = saved.layer.in(document);
	const QString file = place.filePath(saved.path);
	if (saved.stage)
		writeStageFile(file, layer, saved.stage, progress);
	else if (saved.curve)
		writeCurveFile(file, layer, *saved.curve);
	else
		writeMeshFile(file, layer, progress);
}

/// The project as MeshLab writes it, without what it says of the camera.
QByteArray projectText(MeshDocument& document, const std::vector<SavedLayer>& layers)
{
	QByteArray text;
	QXmlStreamWriter xml(&text);
	xml.setAutoFormatting(true);
	xml.writeStartDocument();
	xml.writeDTD("<!DOCTYPE MeshLabDocument>");
	xml.writeStartElement("MeshLabProject");
	xml.writeStartElement("MeshGroup");
	std::vector<std::optional<host::ProjectLook>> looks;
	for (const SavedLayer& saved : layers)
		looks.push_back(host::projectLook(document, saved.layer.in(document)));
	// MeshLab uses them only if all layers have them.
	const bool all = std::all_of(looks.begin(), looks.end(), [](const auto& look) { return look; });
	auto look = looks.begin();
	for (const SavedLayer& saved : layers) {
		const MeshModel& layer = saved.layer.in(document);
		xml.writeStartElement("MLMesh");
		xml.writeAttribute("label", layer.label());
		xml.writeAttribute("filename", saved.path);
		xml.writeAttribute("visible", layer.isVisible() ? "1" : "0");
		xml.writeAttribute("idInFile", "-1");
		QString matrix = "\n";
		for (int row = 0; row < 4; ++row) {
			for (int column = 0; column < 4; ++column)
				matrix += QString::number(layer.cm.Tr.ElementAt(row, column), 'g', 17) + " ";
			matrix += "\n";
		}
		xml.writeTextElement("MLMatrix44", matrix);
		if (all) {
			xml.writeStartElement("RenderingOption");
			for (const auto& [name, value] : (*look)->attributes)
				xml.writeAttribute(name, value);
			xml.writeCharacters((*look)->text);
			xml.writeEndElement();
		}
		++look;
		xml.writeEndElement();
	}
	xml.writeEndElement();
	xml.writeEmptyElement("RasterGroup");
	xml.writeEndElement();
	xml.writeEndDocument();
	return text;
}

Results saveProject(FilterRun& run)
{
	QString project = requiredName(run.parameters.text("file"), "to write");
	if (QFileInfo(project).suffix().compare("mlp", Qt::CaseInsensitive) != 0)
		project += ".mlp";
	const QDir place = QFileInfo(project).absoluteDir();
	const QString folder = QFileInfo(project).completeBaseName() + "_layers";
	std::vector<SavedLayer> layers = layersToSave(run, folder);
	if (host::rasterCount(run.document) > 0)
		run.log("The raster layers are not saved.");
	const QByteArray text = projectText(run.document, layers);
	const bool isNew = !QFileInfo::exists(place.filePath(folder));
	if (!place.exists() || !place.mkpath(folder))
		throw FileError("Cannot make the folder '" + place.filePath(folder).toStdString() + "'.");
	for (size_t i = 0; i < layers.size(); ++i) {
		const mcf::Progress part = run.progress.part(
			double(i) / double(layers.size()), double(i + 1) / double(layers.size()));
		// No cancelling once the first file is replaced: an existing project would be left with a
		// mixture of old and new layers.
		try {
			writeLayer(run.document, layers[i], place, i == 0 ? part : part.showOnly());
		}
		catch (...) {
			if (isNew && i == 0)
				place.rmdir(folder);
			throw;
		}
	}
	writeFile(project, [&](std::ostream& out) { out.write(text.constData(), text.size()); });
	for (const SavedLayer& saved : layers) {
		MeshModel& layer = saved.layer.in(run.document);
		const QString label = layer.label();
		layer.setFileName(place.filePath(saved.path));
		layer.setLabel(label);
	}
	run.log(QString("Wrote '%1' and the folder '%2'.").arg(project, folder));
	return {{"layers", int(layers.size())}};
}

} // namespace

FilterSpec saveProjectFilter()
{
	return {"save_project_mcf", menuName("Save Project"),
		helpPage(
			"Writes all layers and a project file (.mlp), which MeshLab's Open Project reads. MeshLab's own "
			"Save Project loses the edges of skeletons and the state of stages; here skeletons keep their edges, "
			"radius and correspondence, and stages all that the next step needs. The layers are PLY files in a "
			"folder NAME_layers beside the project; files that they were loaded from are left alone. Textures "
			"and raster layers are not saved."),
		FilterCategory::Remeshing, MeshModel::MM_NONE,
		{{ParameterKind::FileToSave, "file", 0, "File", "Name of the project to write, .mlp.",
			{"*.mlp"}}},
		saveProject};
}

} // namespace mcfskel
