// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "formats.h"

#include "../layers/fields.h"
#include "files.h"

#include <skeleton/skeleton_files.h>

#include <QFileInfo>

#include <algorithm>
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

QStringList writeSwc(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
{
	return toLines(mcf::writeSwc(out, skeleton, context.swc).warnings);
}

QStringList writeCg(std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext&)
{
	mcf::writeCg(out, skeleton);
	return {};
}

QStringList writeGraphml(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
{
	mcf::writeGraphml(out, skeleton, context.surfaceName);
	return {};
}

QStringList writeJson(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
{
	mcf::writeJson(out, skeleton, context.surfaceName);
	return {};
}

QStringList writeVtp(std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext&)
{
	mcf::writeVtp(out, skeleton);
	return {};
}

QStringList writeGlb(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
{
	mcf::writeGlb(out, skeleton, context.surface, context.boneTolerance, context.surfaceName,
		context.progress);
	return {};
}

QStringList writePly(
	std::ostream& out, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
{
	mcf::writeSkeletonPly(out, skeleton, context.surfaceFingerprint, context.diagonal);
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
		{"vtp", "VTK PolyData of a curve skeleton", true, writeVtp, nullptr},
		{"glb", "glTF of a surface with an armature", false, writeGlb, nullptr, true},
		{"ply", "PLY with edges", false, writePly, nullptr},
	};
	return formats;
}

bool needsSurface(const QString& file)
{
	const SkeletonFormat* format = formatOf(file);
	return format && format->needsSurface;
}

QStringList writeSkeleton(
	const QString& file, const mcf::CurveSkeleton& skeleton, const SkeletonContext& context)
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
	QStringList warnings;
	writeFile(file, [&](std::ostream& out) { warnings = format->write(out, skeleton, context); });
	return warnings;
}

FileOutcome saveSkeleton(const QString& file, const MeshModel& layer)
{
	return guarded(file, [&](FileOutcome& outcome) {
		CurveLayer curve = readCurve(layer);
		SkeletonContext context;
		curve.skeleton.node = curve.nodeOfLayerVertex();
		if (!curve.skeleton.node.empty())
			context.surfaceName = curve.surfaceName.toStdString();
		outcome.warnings = writeSkeleton(file, curve.skeleton, context);
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
		const std::vector<double> radius = content.skeleton.radius;
		fillCurve(layer, {std::move(content.skeleton), {}, {}});
		if (!radius.empty()) {
			setVertexColours(layer, radius, 0, *std::max_element(radius.begin(), radius.end()));
			outcome.mask |= vcg::tri::io::Mask::IOM_VERTCOLOR;
		}
	});
}

} // namespace mcfskel
