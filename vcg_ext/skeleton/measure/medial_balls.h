// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The shape that a skeleton describes: the union of its balls, as a surface.

#ifndef VCG_MCF_MEDIAL_BALLS_H
#define VCG_MCF_MEDIAL_BALLS_H

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/complex/complex.h>

// There, unreachable branches leave variables unset.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <vcg/complex/algorithms/create/marching_cubes.h>
#include <vcg/complex/algorithms/create/mc_trivial_walker.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// Points and triangles, mesh units.
struct BallUnion
{
	std::vector<Point3d> points;
	std::vector<Triangle> triangles;
};

namespace detail {

class CubeVertex;
class CubeFace;
struct CubeTypes : UsedTypes<Use<CubeVertex>::AsVertexType, Use<CubeFace>::AsFaceType>
{
};
class CubeVertex : public Vertex<CubeTypes, vertex::Coord3d, vertex::BitFlags>
{
};
class CubeFace : public Face<CubeTypes, face::VertexRef, face::BitFlags>
{
};
class CubeMesh : public TriMesh<std::vector<CubeVertex>, std::vector<CubeFace>>
{
};

} // namespace detail

/**
 * The surface of a union of balls, by marching cubes on the distance
 *     f(q) = min_i |q - centre_i| - radius_i.
 *
 * @param centre, radius  mesh units; balls of radius <= 0 do not count.
 * @param voxel           edge of the cubes, mesh units, > 0: what is thinner may be missed.
 * @return closed, normals outward.
 * @throws InvalidParameter if the voxel is not positive, or so small that the grid would have more
 *         than 30 million; InvalidInput if no radius is positive; Cancelled.
 * Complexity: O(voxels + sum of the balls' voxels).
 * Source: Lorensen and Cline, "Marching cubes", 1987, in vcg's version.
 */
inline BallUnion unionOfBalls(const std::vector<Point3d>& centre, const std::vector<double>& radius,
	double voxel, const Progress& progress = Progress())
{
	constexpr double maxVoxels = 3e7;
	constexpr int margin = 3; // voxels; the walker leaves out the last two layers
	const char* what = "Joining the balls";
	requireParameter(voxel > 0 && std::isfinite(voxel), "voxel", "greater than 0");
	Box3d box;
	for (size_t i = 0; i < centre.size(); ++i)
		if (radius[i] > 0)
			for (int side : {-1, 1})
				box.Add(centre[i] + Point3d(1, 1, 1) * (side * radius[i]));
	if (box.IsNull())
		throw InvalidInput(
			"No node of the skeleton has a radius: there is no ball to join. Give its "
			"surface, from which the radius can be measured.");
	const auto cellsAlong = [&](int axis, double side) {
		return std::ceil(box.Dim()[axis] / side) + 2 * margin + 1;
	};
	const auto voxelsOf = [&](double side) {
		return cellsAlong(0, side) * cellsAlong(1, side) * cellsAlong(2, side);
	};
	if (!(voxelsOf(voxel) <= maxVoxels)) {
		double enough = box.Dim()[box.MaxDim()] / maxVoxels;
		while (voxelsOf(enough) > maxVoxels)
			enough *= 1.01;
		throw InvalidParameter("Voxels as small as this would be "
			+ detail::countText(voxelsOf(voxel) / 1e6) + " million: choose a voxel of at least "
			+ detail::lowerBoundText(enough) + " mesh units.");
	}
	Point3i size;
	for (int axis = 0; axis < 3; ++axis)
		size[axis] = int(cellsAlong(axis, voxel));

	// In coordinates where a voxel is 1.
	using Volume = SimpleVolume<SimpleVoxel<double>>;
	const Point3d origin = box.min - Point3d(1, 1, 1) * (margin * voxel);
	const double far = 2 * margin;
	Volume volume;
	volume.Init(size, Box3d(Point3d(0, 0, 0), Point3d(size[0], size[1], size[2])));
	for (auto& cell : volume.Vol)
		cell.V() = far;
	for (size_t i = 0; i < centre.size(); ++i) {
		if (i % 256 == 0)
			progress.report(0.7 * double(i) / double(centre.size()), what);
		if (!(radius[i] > 0))
			continue;
		const Point3d c = (centre[i] - origin) / voxel;
		const double r = radius[i] / voxel;
		// Corners of cubes that the surface may cross are less than two voxels away from it.
		int low[3], high[3];
		for (int axis = 0; axis < 3; ++axis) {
			low[axis] = std::max(0, int(std::floor(c[axis] - r - 2)));
			high[axis] = std::min(size[axis] - 1, int(std::ceil(c[axis] + r + 2)));
		}
		for (int z = low[2]; z <= high[2]; ++z) {
			progress.check(); // a large ball has millions of voxels
			for (int y = low[1]; y <= high[1]; ++y)
				for (int x = low[0]; x <= high[0]; ++x) {
					double& value = volume.Val(x, y, z);
					const double limit = value + r;
					const double squared = SquaredDistance(Point3d(x, y, z), c);
					if (limit > 0 && squared < limit * limit)
						value = std::sqrt(squared) - r;
				}
		}
	}
	// No corner exactly on the surface: it would make triangles of no area.
	constexpr double minimum = 1e-4;
	for (auto& cell : volume.Vol)
		if (std::abs(cell.V()) < minimum)
			cell.V() = cell.V() < 0 ? -minimum : minimum;

	progress.report(0.8, what);
	using Walker = TrivialWalker<detail::CubeMesh, Volume>;
	detail::CubeMesh mesh;
	Walker walker;
	MarchingCubes<detail::CubeMesh, Walker> cubes(mesh, walker);
	walker.BuildMesh(mesh, volume, cubes, 0);

	BallUnion soup;
	for (const detail::CubeVertex& v : mesh.vert)
		soup.points.push_back(v.cP() * voxel + origin);
	for (const detail::CubeFace& f : mesh.face)
		soup.triangles.push_back(
			{int(Index(mesh, f.cV(0))), int(Index(mesh, f.cV(1))), int(Index(mesh, f.cV(2)))});
	progress.report(1, what);
	return soup;
}

} // namespace vcg::tri::mcf

#endif
