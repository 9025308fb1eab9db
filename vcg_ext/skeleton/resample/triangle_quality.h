// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Which collapses, flips and moves keep the shape of a surface.

#ifndef VCG_MCF_TRIANGLE_QUALITY_H
#define VCG_MCF_TRIANGLE_QUALITY_H

#include <skeleton/mesh/surface_mesh.h>

namespace vcg::tri::mcf::detail {

/// Whether a triangle that had the area vector `before` turns by more than 70 degrees or loses its
/// area. A triangle without area had no direction to keep.
inline bool turnsOver(const Point3d& before, const Point3d& after)
{
	constexpr double squaredCosine = 0.117;
	const double cosine = before * after;
	const double squaredAreas = before.SquaredNorm() * after.SquaredNorm();
	return squaredAreas > 0 ? cosine <= 0 || cosine * cosine < squaredCosine * squaredAreas
							: after.SquaredNorm() <= 0;
}

/**
 * Whether the triangles around v, but for the two that disappear with half-edge `gone`, turn by
 * less than 70 degrees and get no edge longer than wanted when v moves to `point`. An edge that
 * was longer already may grow a little: else a fan of needles could not lose its short edges.
 */
inline bool ringAllowsMove(
	const SurfaceMesh& mesh, int v, const Point3d& point, int gone, double squaredLongest)
{
	constexpr double squaredStretch = 1.1;
	const int goneFace = gone / 3, goneTwin = mesh.twin(gone) / 3;
	const Point3d& old = mesh.position[v];
	const int first = mesh.outgoing(v);
	int h = first;
	do {
		const Point3d& p = mesh.position[mesh.target(h)];
		const double squared = SquaredDistance(p, point);
		if (squared > squaredLongest && squared > squaredStretch * SquaredDistance(p, old))
			return false;
		const int f = h / 3;
		if (f != goneFace && f != goneTwin) {
			const Point3d side = mesh.position[mesh.apex(h)] - p;
			const Point3d before = side ^ (old - p), after = side ^ (point - p);
			if (turnsOver(before, after))
				return false;
		}
		h = mesh.rotated(h);
	} while (h != first);
	return true;
}

/// Whether h can be flipped and both new normals are within 60 degrees of the mean old one.
inline bool flipKeepsShape(const SurfaceMesh& mesh, int h)
{
	constexpr double minCosine = 0.5;
	const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
	const Point3d &c = mesh.position[mesh.apex(h)], &d = mesh.position[mesh.apex(mesh.twin(h))];
	const Point3d before = ((b - a) ^ (c - a)) + ((d - a) ^ (b - a));
	const double scale = minCosine * before.Norm();
	const Point3d left = (c - d) ^ (a - d), right = (d - c) ^ (b - c);
	return left * before > scale * left.Norm() && right * before > scale * right.Norm()
		&& mesh.isFlippable(h);
}

/// Whether the two angles opposite to h add up to more than 180 degrees, by more than an angle
/// whose sine is `margin`.
inline bool opposesWideAngles(const SurfaceMesh& mesh, int h, double margin)
{
	const Point3d &a = mesh.position[mesh.origin(h)], &b = mesh.position[mesh.target(h)];
	const Point3d &c = mesh.position[mesh.apex(h)], &d = mesh.position[mesh.apex(mesh.twin(h))];
	const Point3d ac = a - c, bc = b - c, ad = a - d, bd = b - d;
	const double cosineC = ac * bc, cosineD = ad * bd;
	if (cosineC >= 0 && cosineD >= 0) // nearly always, without a square root
		return false;
	const double sineC = (ac ^ bc).Norm(), sineD = (ad ^ bd).Norm();
	const double sine = cosineC * sineD + sineC * cosineD;
	if (sine >= 0)
		return false;
	const double cosine = cosineC * cosineD - sineC * sineD;
	return cosine > 0 || sine * sine > margin * margin * (sine * sine + cosine * cosine);
}

} // namespace vcg::tri::mcf::detail

#endif
