// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Leaves out the pieces of a surface that get no skeleton: cavities, and the smallest ones.

#ifndef VCG_MCF_SOLID_PIECES_H
#define VCG_MCF_SOLID_PIECES_H

#include "winding_number.h"

#include <skeleton/core/notes.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/graph/closest_curve.h>
#include <skeleton/graph/curve_skeleton.h>
#include <skeleton/input/check_input.h>
#include <skeleton/mesh/components.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/spatial/box_tree.h>
#include <skeleton/spatial/triangle_tree.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// What becomes of cavities: closed pieces inside a body, oriented against it.
enum class Cavities {
	Kept,     ///< they are not looked for, and stay as bodies
	Reported, ///< they stay as bodies, and a note says so
	LeftOut
};

/// What keepSolidPieces() has found and left out.
struct LeftOutPieces
{
	int small = 0;
	int cavities = 0;
	/// Cavities that were found and stay as bodies.
	int cavitiesKept = 0;
	/// The whole surface with its cavities turned inward, the boundary of the paper's solid O
	/// (Sec. 4); null if no cavity was found.
	std::shared_ptr<const SurfaceMesh> hollow;

	bool any() const { return small > 0 || cavities > 0; }
	/// One sentence each for the log.
	std::vector<std::string> notes() const
	{
		std::vector<std::string> list;
		if (cavities > 0)
			list.push_back(
				cavities == 1 ? std::string(
					"1 piece is turned against the body around: a cavity. It gets no skeleton, and the body is taken as if it were full, so that a curve may run in the cavity.")
							  : std::to_string(cavities)
						+ " pieces are turned against the bodies around: cavities. They get no skeleton, and the bodies are taken as if they were full, so that curves may run in the cavities.");
		if (cavitiesKept > 0)
			list.push_back(
				cavitiesKept == 1 ? std::string(
					"1 piece is turned against the body around: a cavity. Without repair it gets a skeleton as if it were a body.")
								  : std::to_string(cavitiesKept)
						+ " pieces are turned against the bodies around: cavities. Without repair they get skeletons as if they were bodies.");
		if (small > 0)
			list.push_back(detail::sentence(6, small, small == 1 ? " piece gets" : " pieces get",
				" no skeleton, smaller than min_component beside the largest."));
		return list;
	}
};

namespace detail {

/// The connected components of a closed surface; the volume of one that faces inward is negative.
struct ClosedPieces
{
	std::vector<int> ofVertex;
	std::vector<std::vector<Triangle>> faces;
	std::vector<std::vector<int>> vertices;
	std::vector<double> volume;
	std::vector<Box3d> box;

	ClosedPieces(const SurfaceMesh& mesh, const Progress& progress)
	{
		const char* const what = "Measuring the pieces";
		int count = 0;
		ofVertex = connectedComponents(mesh, &count, progress.part(0, 0.5));
		faces.resize(size_t(count));
		vertices.resize(size_t(count));
		volume.resize(size_t(count), 0);
		box.resize(size_t(count));
		reportedLoop(mesh.vertexSlots(), progress.part(0.5, 0.7), what, [&](int v) {
			if (!mesh.isVertex(v))
				return;
			vertices[size_t(ofVertex[size_t(v)])].push_back(v);
			box[size_t(ofVertex[size_t(v)])].Add(mesh.position[size_t(v)]);
		});
		reportedLoop(mesh.faceSlots(), progress.part(0.7, 1), what, [&](int f) {
			if (!mesh.isFace(f))
				return;
			const Triangle t = mesh.triangle(f);
			const size_t piece = size_t(ofVertex[size_t(t[0])]);
			const Point3d& origin = mesh.position[size_t(vertices[piece][0])];
			volume[piece] += (mesh.position[size_t(t[0])] - origin) * mesh.doubleAreaVector(f) / 6;
			faces[piece].push_back(t);
		});
	}

	size_t count() const { return faces.size(); }
};

/// For each piece whether it is a cavity: oriented against the smallest piece around it, which is
/// not one. @param turned  of each piece, see CheckedSurface::turned. @throws Cancelled
/// Complexity: see keepSolidPieces().
inline std::vector<char> cavitiesAmong(const SurfaceMesh& mesh, const ClosedPieces& pieces,
	const std::vector<char>& turned, const Progress& progress)
{
	constexpr size_t samples = 500; // up to twice as many vertices of a piece must all be inside
	std::vector<int> bySize(pieces.count());
	std::iota(bySize.begin(), bySize.end(), 0);
	std::stable_sort(bySize.begin(), bySize.end(),
		[&](int a, int b) { return pieces.volume[size_t(a)] > pieces.volume[size_t(b)]; });
	struct Body
	{
		TriangleTree tree;
		WindingNumber winding;

		Body(const std::vector<Point3d>& points, const std::vector<Triangle>& faces,
			const Progress& progress) :
				tree(points, faces, progress),
				winding(tree, progress)
		{
		}
	};
	std::vector<std::unique_ptr<Body>> bodies(pieces.count());
	const auto isInside = [&](size_t inner, size_t outer) {
		if (!bodies[outer])
			bodies[outer] =
				std::make_unique<Body>(mesh.position, pieces.faces[outer], progress.cancelOnly());
		progress.check();
		const std::vector<int>& vertices = pieces.vertices[inner];
		const size_t step = std::max<size_t>(1, vertices.size() / samples);
		for (size_t i = 0; i < vertices.size(); i += step)
			if (!(bodies[outer]->winding(mesh.position[size_t(vertices[i])]) > 0.75))
				return false;
		return true;
	};
	std::vector<Box3d> boxes;
	for (int piece : bySize)
		boxes.push_back(pieces.box[size_t(piece)]);
	const BoxTree tree(boxes, progress.part(0, 0.1));
	std::vector<char> cavity(pieces.count(), 0);
	std::vector<int> larger; // places in `bySize` of pieces with the box around
	for (int i = 0; i < int(bySize.size()); ++i) {
		progress.report(0.1 + 0.9 * i / double(bySize.size()), "Looking for cavities");
		const size_t piece = size_t(bySize[size_t(i)]);
		const Box3d& box = boxes[size_t(i)];
		larger.clear();
		tree.forEachIn(Box3d(box.min, box.min), [&](int k) {
			if (k < i && boxes[size_t(k)].IsIn(box.max))
				larger.push_back(k);
		});
		std::sort(larger.begin(), larger.end(), std::greater<>());
		for (int k : larger) {
			const size_t around = size_t(bySize[size_t(k)]);
			if (!isInside(piece, around))
				continue;
			cavity[piece] = !cavity[around] && turned[piece] != turned[around];
			break;
		}
	}
	return cavity;
}

} // namespace detail

/**
 * The fraction of a skeleton that lies outside a solid: of its length, or of its nodes where it has
 * no edges.
 *
 * A point is inside where the winding number of the boundary is at least 1/2. In a cavity those of
 * the body and of the cavity cancel out; in a body inside the cavity its own is left.
 * @param boundary  closed, cavities turned inward, see LeftOutPieces::hollow.
 * @return in [0, 1]; 0 for an empty skeleton. @throws Cancelled
 * Complexity: O(F log F), and about O(log F) for each 0.1 % of the diagonal along the skeleton.
 */
inline double partOutside(const CurveSkeleton& skeleton, const SurfaceMesh& boundary,
	const Progress& progress = Progress())
{
	constexpr double spacing = 0.001; // of the diagonal
	const std::vector<Triangle> faces = boundary.triangles(progress);
	const TriangleTree tree(boundary.position, faces, progress.part(0, 0.5));
	const WindingNumber winding(tree, progress.part(0.5, 0.7));
	CurveSamples samples = curveSamples(skeleton, spacing * boundary.bounds(progress).Diag());
	if (skeleton.edges.empty())
		samples.weight.assign(samples.weight.size(), 1);
	double all = 0, outside = 0;
	detail::reportedLoop(
		int(samples.position.size()), progress.part(0.7, 1), "Measuring the skeleton", [&](int i) {
			const double weight = samples.weight[size_t(i)];
			if (!(weight > 0))
				return;
			all += weight;
			if (winding(samples.position[size_t(i)]) < 0.5)
				outside += weight;
		});
	return all > 0 ? outside / all : 0;
}

/// A copy of a surface with some pieces turned over. @param piece  of each vertex, see
/// connectedComponents(). @param isTurned  of each piece. @throws Cancelled
inline SurfaceMesh withPiecesTurned(const SurfaceMesh& mesh, const std::vector<int>& piece,
	const std::vector<char>& isTurned, const Cancellation& cancel = Cancellation())
{
	SurfaceMesh result = mesh.copied(cancel);
	result.turnOver([&](int v) { return isTurned[size_t(piece[size_t(v)])] != 0; }, cancel);
	return result;
}

/**
 * The surface of a solid with its cavities turned inward, so that points in them are outside of it.
 * @param turned  see CheckedSurface::turned; if empty there are no cavities.
 * @param count  becomes the number of cavities.
 * @return nothing if there is none. Complexity: as keepSolidPieces(). @throws Cancelled
 */
inline std::optional<SurfaceMesh> withCavitiesInward(const SurfaceMesh& mesh,
	const std::vector<char>& turned, int& count, const Progress& progress = Progress())
{
	count = 0;
	if (turned.empty())
		return std::nullopt;
	const detail::ClosedPieces pieces(mesh, progress.part(0, 0.4));
	const std::vector<char> cavity =
		detail::cavitiesAmong(mesh, pieces, turned, progress.part(0.4, 0.9));
	count = int(std::count(cavity.begin(), cavity.end(), 1));
	if (count == 0)
		return std::nullopt;
	return withPiecesTurned(mesh, pieces.ofVertex, cavity, progress);
}

/**
 * Leaves out the pieces of a surface that get no skeleton; `vertexOfInput` becomes -1 for their
 * vertices, and `turned` empty.
 *
 * A cavity is a closed piece that lies wholly inside a body and was given oriented against it: see
 * CheckedSurface::turned. A piece inside a cavity is a body again.
 *
 * @param minimum  volume below which a piece is left out, as a part of the largest's; 0: none is.
 * @param cavities  what becomes of them.
 * @throws Cancelled. Complexity: O(V + F); where some of P pieces are turned against others also
 *         about O(P log P), and O(F log F) for each that has another one in its box.
 */
inline LeftOutPieces keepSolidPieces(CheckedSurface& surface, double minimum, Cavities cavities,
	const Progress& progress = Progress())
{
	LeftOutPieces leftOut;
	const bool areSought = cavities != Cavities::Kept && !surface.turned.empty();
	if (!(minimum > 0) && !areSought)
		return leftOut;
	SurfaceMesh& mesh = surface.mesh;
	const detail::ClosedPieces pieces(mesh, progress.part(0, 0.3));
	std::vector<char> drop(pieces.count(), 0);
	if (areSought) {
		drop = detail::cavitiesAmong(mesh, pieces, surface.turned, progress.part(0.3, 0.8));
		const int found = int(std::count(drop.begin(), drop.end(), 1));
		if (found > 0)
			leftOut.hollow = std::make_shared<const SurfaceMesh>(
				withPiecesTurned(mesh, pieces.ofVertex, drop, progress));
		if (cavities == Cavities::LeftOut)
			leftOut.cavities = found;
		else {
			leftOut.cavitiesKept = found;
			drop.assign(drop.size(), 0);
		}
	}
	double largest = 0;
	for (size_t p = 0; p < pieces.count(); ++p)
		if (!drop[p])
			largest = std::max(largest, pieces.volume[p]);
	for (size_t p = 0; p < pieces.count(); ++p)
		if (!drop[p] && pieces.volume[p] < minimum * largest) {
			drop[p] = 1;
			++leftOut.small;
		}
	for (std::string& note : leftOut.notes())
		surface.notes.push_back(std::move(note));
	if (!leftOut.any())
		return leftOut;

	std::vector<int> number(size_t(mesh.vertexSlots()), -1);
	std::vector<Point3d> points;
	for (int v = 0; v < mesh.vertexSlots(); ++v)
		if (mesh.isVertex(v) && !drop[size_t(pieces.ofVertex[size_t(v)])]) {
			number[size_t(v)] = int(points.size());
			points.push_back(mesh.position[size_t(v)]);
		}
	std::vector<Triangle> kept;
	for (const Triangle& t : mesh.triangles(progress))
		if (number[size_t(t[0])] >= 0)
			kept.push_back({number[size_t(t[0])], number[size_t(t[1])], number[size_t(t[2])]});
	for (int& v : surface.vertexOfInput)
		v = v < 0 ? -1 : number[size_t(v)];
	mesh = SurfaceMesh(std::move(points), kept, progress.part(0.8, 1));
	surface.turned.clear();
	return leftOut;
}

} // namespace vcg::tri::mcf

#endif
