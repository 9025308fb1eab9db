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
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <QSet>
#include <QTemporaryDir>
#include <QXmlStreamReader>
#include <QXmlStreamWriter>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <ostream>
#include <utility>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

/// A layer, what is known of it, and where it goes.
struct SavedLayer
{
	LayerAsRead layer;
	StageLayer stage;
	std::shared_ptr<const CurveLayer> curve;
	QString name; ///< of the file
};

/// The file of a project and the folder of its layers.
struct ProjectPlace
{
	QString file;
	QDir folder;
	QString layers; ///< the folder of the layers, from `folder`

	QString pathOf(const SavedLayer& saved) const { return layers + "/" + saved.name; }
	QString fileOf(const SavedLayer& saved) const { return folder.filePath(pathOf(saved)); }
};

/// The names of the layer files that the project there, if there is one, has in its folder.
QSet<QString> ownNames(const ProjectPlace& place)
{
	QSet<QString> names;
	QFile file(place.file);
	if (!file.open(QIODevice::ReadOnly))
		return names;
	const QString layers = QDir::cleanPath(place.folder.absoluteFilePath(place.layers));
	QXmlStreamReader xml(&file);
	while (!xml.atEnd())
		if (xml.readNext() == QXmlStreamReader::StartElement && xml.name() == QString("MLMesh")) {
			const QString path = xml.attributes().value(QString("filename")).toString();
			const QFileInfo named(QDir::cleanPath(place.folder.absoluteFilePath(path)));
			if (named.path() == layers && named.isFile())
				names.insert(named.fileName());
		}
	return names;
}

/// What no layer's file may be called, in lower case and without ".ply": what is there and is not
/// the project's own. A layer may have been loaded from it.
QSet<QString> takenNames(const ProjectPlace& place)
{
	const QSet<QString> own = ownNames(place);
	const QDir layers(place.folder.filePath(place.layers));
	QSet<QString> taken;
	for (QString name :
		layers.entryList(QDir::AllEntries | QDir::Hidden | QDir::System | QDir::NoDotAndDotDot))
		if (!own.contains(name) && name.endsWith(".ply", Qt::CaseInsensitive)) {
			name.chop(4);
			taken.insert(name.toLower());
		}
	return taken;
}

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
std::vector<SavedLayer> layersToSave(const FilterRun& run, const ProjectPlace& place)
{
	std::vector<SavedLayer> saved;
	QSet<QString> taken = takenNames(place);
	for (const MeshModel* found : host::layersOf(run.document)) {
		const MeshModel& layer = *found;
		SavedLayer item {LayerAsRead(layer), {}, nullptr, fileName(layer, taken)};
		takeState(run, layer, item);
		if (!layer.cm.textures.empty())
			run.log("The textures of '" + layer.label() + "' are not saved.");
		saved.push_back(std::move(item));
	}
	return saved;
}

void writeLayer(MeshDocument& document, const SavedLayer& saved, const QString& file,
	const mcf::Progress& progress)
{
	const MeshModel& layer = saved.layer.in(document);
	if (saved.stage)
		writeStageFile(file, layer, saved.stage, progress);
	else if (saved.curve)
		writeCurveFile(file, layer, *saved.curve);
	else
		writeMeshFile(file, layer, progress);
}

/// The files of the layers. They are written to a folder inside theirs first, and take their places
/// together. Unless they are kept in the end, all is as it was.
class LayerFiles
{
public:
	/// @param layers  are kept by reference. @throws FileError
	LayerFiles(const ProjectPlace& place, const std::vector<SavedLayer>& layersToWrite) :
			place(place), saved(layersToWrite),
			isNew(!QFileInfo::exists(place.folder.filePath(place.layers)))
	{
		moved.reserve(2 * saved.size()); // there may be no memory to put things back
		const QString layers = place.folder.filePath(place.layers);
		if (!place.folder.exists() || !place.folder.mkpath(place.layers))
			throw FileError("Cannot make the folder '" + layers.toStdString() + "'.");
		drafts = std::make_unique<QTemporaryDir>(layers + "/.mcfskel-XXXXXX");
		if (drafts->isValid() && QDir(drafts->path()).mkdir(replaced)) {
			drafts->setAutoRemove(false); // the destructor does, once what was replaced is back
			return;
		}
		const std::string why = drafts->errorString().toStdString();
		removeFolders();
		throw FileError("Cannot write into the folder '" + layers.toStdString()
			+ (why.empty() ? "'." : "': " + why));
	}

	~LayerFiles()
	{
		try {
			if (!isKept)
				putBack();
			removeFolders();
		}
		catch (const std::bad_alloc&) {
			// What was replaced is still there, in the folder of the drafts.
		}
	}

	LayerFiles(const LayerFiles&) = delete;
	LayerFiles& operator=(const LayerFiles&) = delete;

	/// Where a layer is to be written.
	QString draftOf(const SavedLayer& layer) const { return drafts->filePath(layer.name); }

	/// Puts all drafts in their places. @throws FileError
	void takePlaces()
	{
		for (const SavedLayer& layer : saved) {
			const QString file = place.fileOf(layer);
			if (QFileInfo::exists(file)) {
				if (!QFileInfo(file).isWritable())
					throw FileError("Cannot write '" + file.toStdString() + "': Permission denied");
				move(file, replacedBy(layer));
			}
			move(draftOf(layer), file);
		}
	}

	/// Keeps the new files.
	void keep() { isKept = true; }

private:
	/// A folder in that of the drafts, for what they replace: no layer's file has such a name.
	static constexpr char replaced[] = "replaced";

	QString replacedBy(const SavedLayer& layer) const
	{
		return drafts->filePath(replaced + QString("/") + layer.name);
	}

	void move(const QString& from, const QString& to)
	{
		moved.emplace_back(from, to);
		QFile file(from);
		if (file.rename(to))
			return;
		moved.pop_back();
		throw FileError(QString("Cannot write '%1': %2").arg(to, file.errorString()).toStdString());
	}

	void putBack()
	{
		for (; !moved.empty(); moved.pop_back())
			QFile::rename(moved.back().second, moved.back().first);
	}

	/// File by file: to list a folder takes memory, which may be what there is too little of.
	void removeFolders()
	{
		for (const SavedLayer& layer : saved) {
			QFile::remove(draftOf(layer));
			if (isKept) // else what could not be put back would be lost
				QFile::remove(replacedBy(layer));
		}
		QDir().rmdir(drafts->filePath(replaced));
		QDir().rmdir(drafts->path());
		if (isNew && !isKept)
			place.folder.rmdir(place.layers);
	}

	ProjectPlace place;
	const std::vector<SavedLayer>& saved;
	bool isNew;
	bool isKept = false;
	std::unique_ptr<QTemporaryDir> drafts;
	std::vector<std::pair<QString, QString>> moved; ///< from, to
};

/// The project as MeshLab writes it, without what it says of the camera.
QByteArray projectText(
	MeshDocument& document, const std::vector<SavedLayer>& layers, const ProjectPlace& place)
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
		xml.writeAttribute("filename", place.pathOf(saved));
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
	const ProjectPlace place {project, QFileInfo(project).absoluteDir(),
		QFileInfo(project).completeBaseName() + "_layers"};
	std::vector<SavedLayer> layers = layersToSave(run, place);
	if (host::rasterCount(run.document) > 0)
		run.log("The raster layers are not saved.");
	const QByteArray text = projectText(run.document, layers, place);
	LayerFiles files(place, layers);
	for (size_t i = 0; i < layers.size(); ++i) {
		const mcf::Progress part = run.progress.part(
			double(i) / double(layers.size()), double(i + 1) / double(layers.size()));
		const QString draft = files.draftOf(layers[i]);
		try {
			writeLayer(run.document, layers[i], draft, part);
		}
		catch (const FileError& error) {
			// The user knows the file by the name that it was to get.
			throw FileError(QString::fromUtf8(error.what())
								.replace(draft, place.fileOf(layers[i]))
								.toStdString());
		}
	}
	files.takePlaces();
	writeFile(project, [&](std::ostream& out) { out.write(text.constData(), text.size()); });
	files.keep();
	for (const SavedLayer& saved : layers) {
		MeshModel& layer = saved.layer.in(run.document);
		const QString label = layer.label();
		layer.setFileName(place.fileOf(saved));
		layer.setLabel(label);
	}
	run.log(QString("Wrote '%1' and the folder '%2'.").arg(project, place.layers));
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
