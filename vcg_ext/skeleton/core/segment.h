// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The closest point of a segment.

#ifndef VCG_MCF_SEGMENT_H
#define VCG_MCF_SEGMENT_H

#include <vcg/space/point3.h>

#include <algorithm>

namespace vcg::tri::mcf {

/// A point of the segment from a to b: a + t (b - a), t in [0, 1].
struct SegmentPoint
{
	Point3d point;
	double t;
};

/// The point of the segment from a to b that is closest to `query`; a if the ends coincide.
inline SegmentPoint closestOnSegment(const Point3d& a, const Point3d& b, const Point3d& query)
{
	const Point3d along = b - a;
	const double squared = along.SquaredNorm();
	const double t = squared > 0 ? std::clamp((query - a) * along / squared, 0.0, 1.0) : 0;
	return {a + along * t, t};
}

} // namespace vcg::tri::mcf

#endif
