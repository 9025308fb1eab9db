// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The file formats of skeletons, and how layers are written to and read from them. The
/// adapters in adapters/ offer them in the host's import and export. A new format is a header in
/// vcg_ext/skeleton/io/ and a line in skeletonFormats().

#ifndef MCFSKEL_FORMATS_H
#define MCFSKEL_FORMATS_H

#include "../layers/layers.h"

#include <skeleton/skeleton_files.h>

#include <wrap/io_trimesh/io_mask.h>

#include <QString>
#include <QStringList>

#include <cstdint>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace mcfskel {

/// What a file is made from, besides the skeleton with its correspondence.
struct SkeletonContext
{
	/// Name of the surface's layer, in UTF-8.
	std::string surfaceName;
	/// The surface; without faces if it is not at hand.
	vcg::tri::mcf::SkinnedSurface surface;
	vcg::tri::mcf::SwcOptions swc;
	/// As in SkeletonFile.
	std::uint64_t surfaceFingerprint = 0;
	double diagonal = 0;
	/// How far the bones of an armature may be from the curve, mesh units; 0: the default.
	double boneTolerance = 0;
	/// Used by formats that take long to write; silent unless set.
	vcg::tri::mcf::Progress progress;
};

struct SkeletonFormat
{
	QString extension;
	QString description;
	/// Whether the host's import and export list it. False where hosts have a format of that
	/// extension themselves, which they prefer.
	bool offered;
	/// Returns warnings. Null if the format is not written.
	QStringList (*write)(
		std::ostream&, const vcg::tri::mcf::CurveSkeleton&, const SkeletonContext&);
	/// Null if the format is not read.
	vcg::tri::mcf::SkeletonFile (*read)(std::istream&);
	/// Whether it holds the surface as well.
	bool needsSurface = false;

	bool isWritten() const { return offered && write; }
	bool isRead() const { return offered && read; }
};

const std::vector<SkeletonFormat>& skeletonFormats();

/// What a file may hold, as the host asks for it.
constexpr int writtenElements = vcg::tri::io::Mask::IOM_VERTCOORD
	| vcg::tri::io::Mask::IOM_VERTQUALITY | vcg::tri::io::Mask::IOM_EDGEINDEX;

/**
 * Writes a skeleton to a file of the format that its name ends with.
 * @param skeleton its correspondence has an entry for each vertex of the surface's layer, or of
 *                 `context.surface` where the format needs that.
 * @return warnings, a sentence each.
 * @throws FileError, InvalidInput, Cancelled
 */
QStringList writeSkeleton(const QString& file, const vcg::tri::mcf::CurveSkeleton& skeleton,
	const SkeletonContext& context);

/// Whether the format that a file's name ends with holds the surface as well.
bool needsSurface(const QString& file);

/// How a reading or writing ended. No exception leaves the two functions below.
struct FileOutcome
{
	/// Empty on success.
	QString error;
	QStringList warnings;
	/// VCG's mask of what a file held.
	int mask = 0;
};

/// Writes a skeleton layer.
FileOutcome saveSkeleton(const QString& file, const MeshModel& layer);

/// Reads a file into an empty layer, which stays empty if the file is refused.
FileOutcome openSkeleton(const QString& file, MeshModel& layer);

} // namespace mcfskel

#endif
