// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "formats.h"

#include "files.h"

#include <skeleton/skeleton_files.h>

#include <QFileInfo>

#include <exception>
#include <new>
#include <ostream>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;

namespace {

QStringList toLines(const std::vector<std::string>& texts)
{
	QStringList lines;
	for (const std::string& text : texts)
		lines << QString::fromStdString(text);
	return lines;
}

QStringList writeSwc(std::ostream& out, const mcf::CurveSkeleton& skeleton, const std::string&)
{
	return toLines(mcf::writeSwc(out, skeleton).warnings);
}

QStringList writeCg(std::ostream& out, const mcf::CurveSkeleton& skeleton, const std::string&)
{
	mcf::writeCg(out, skeleton);
	return {};
}

QStringList writeGraphml(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const std::string& surfaceName)
{
	mcf::writeGraphml(out, skeleton, surfaceName);
	return {};
}

QStringList writeJson(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const std::string& surfaceName)
{
	mcf::writeJson(out, skeleton, surfaceName);
	return {};
}

QStringList writePly(std::ostream& out, const mcf::CurveSkeleton& skeleton, const std::string&)
{
	mcf::writeSkeletonPly(out, skeleton);
	return {};
}

/// The format that a file's name ends with; null if there is none.
const SkeletonFormat* formatOf(const QString& file)
{
	for (const SkeletonFormat& format : skeletonFormats())
		if (QFileInfo(file).suffix().compare(format.extension, Qt::CaseInsensitive) == 0)
			return &format;
	return nullptr;
}

/// Runs an action; what it throws becomes the error.
template <class Action>
FileOutcome guarded(const QString& file, Action&& action)
{
	FileOutcome outcome;
	try {
		action(outcome);
	}
	catch (const mcf::FormatError& error) {
		outcome.error = QString("'%1' cannot be read. %2")
							.arg(QFileInfo(file).fileName(), QString::fromUtf8(error.what()));
	}
	catch (const std::bad_alloc&) {
		outcome.error = QString("Not enough memory for '%1'.").arg(QFileInfo(file).fileName());
	}
	catch (const std::exception& error) {
		outcome.error = QString::fromUtf8(error.what());
	}
	catch (...) {
		outcome.error = "An error of unknown kind.";
	}
	return outcome;
}

} // namespace

const std::vector<SkeletonFormat>& skeletonFormats()
{
	static const std::vector<SkeletonFormat> formats = {
		{"swc", "SWC tree of a curve skeleton", true, writeSwc, mcf::readSwc},
		{"cg", "Curve graph", true, writeCg, mcf::readCg},
		{"graphml", "GraphML of a curve skeleton", true, writeGraphml, nullptr},
		{"json", "JSON graph of a curve skeleton", false, writeJson, nullptr},
		{"ply", "PLY with edges", false, writePly, nullptr},
	};
	return formats;
}

QStringList writeSkeleton(const QString& file, const mcf::CurveSkeleton& skeleton,
	const std::vector<int>& sources, const QString& surfaceName)
{
	const SkeletonFormat* format = formatOf(file);
	if (!format || !format->write) {
		QStringList known;
		for (const SkeletonFormat& f : skeletonFormats())
			known << "." + f.extension;
		throw FileError(QString("A skeleton cannot be written to '%1': the name must end with %2.")
							.arg(file, known.join(", "))
							.toStdString());
	}
	mcf::CurveSkeleton copy = skeleton;
	copy.node = sources;
	QStringList warnings;
	writeFile(file, [&](std::ostream& out) {
		warnings =
			format->write(out, copy, sources.empty() ? std::string() : surfaceName.toStdString());
	});
	return warnings;
}

FileOutcome saveSkeleton(const QString& file, const MeshModel& layer)
{
	return guarded(file, [&](FileOutcome& outcome) {
		const CurveLayer curve = readCurve(layer);
		outcome.warnings =
			writeSkeleton(file, curve.skeleton, curve.nodeOfLayerVertex(), curve.surfaceName);
	});
}

FileOutcome openSkeleton(const QString& file, MeshModel& layer)
{
	return guarded(file, [&](FileOutcome& outcome) {
		const SkeletonFormat* format = formatOf(file);
		if (!format || !format->read)
			throw FileError(
				QString("'%1' is of a format that is not read.").arg(file).toStdString());
		InputFile in(file);
		mcf::SkeletonFile content = format->read(in.stream());
		if (content.skeleton.position.empty())
			throw FileError(QString("'%1' has no nodes.").arg(file).toStdString());
		outcome.warnings = toLines(content.warnings);
		outcome.mask = vcg::tri::io::Mask::IOM_VERTCOORD | vcg::tri::io::Mask::IOM_EDGEINDEX;
		if (!content.skeleton.radius.empty())
			outcome.mask |= vcg::tri::io::Mask::IOM_VERTQUALITY;
		fillCurve(layer, {std::move(content.skeleton), {}, {}});
	});
}

} // namespace mcfskel
