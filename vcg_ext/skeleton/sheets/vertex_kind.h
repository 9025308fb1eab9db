// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The kind of each vertex of a stage: curve, sheet, or still volume (Sec. 4.5, Fig. 7).

#ifndef VCG_MCF_VERTEX_KIND_H
#define VCG_MCF_VERTEX_KIND_H

#include <skeleton/spatial/cell_grid.h>
#include <skeleton/core/parallel.h>
#include <skeleton/flow/stage.h>
#include <skeleton/mesh/closest_point_walk.h>
#include <skeleton/mesh/component_meshes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vcg::tri::mcf {

/// The numbers are those of the attribute mcfskel_kind.
enum class VertexKind : char {
	Curve = 0, ///< the surface around has closed onto a line
	Sheet = 1, ///< two walls lie on each other, and extend in two directions
	Volume = 2 ///< not contracted yet
};

namespace detail {

// The lengths that decide between the kinds, in epsilon, see vertexKinds().
constexpr double maxThickness = 2;
constexpr double sheetReach = 8;
constexpr double longestPiece = 4;
constexpr double toldTogether = 3; // leaves a ball of 5: 4.2 is enough in the middle of a sheet
// No point of a piece is farther from the mean of its corners than 2/3 of its longest edge.
constexpr double wallReach = maxThickness + longestPiece * 2 / 3;
constexpr double kindCell = std::max(wallReach, (sheetReach + toldTogether) / 2);

constexpr const char* tellingKinds = "Telling curves from sheets";

inline double epsilonAt(const Stage& stage, int v)
{
	return stage.epsilon * stage.diagonal[stage.component[v]];
}

/// A piece of a triangle of a stage, in single precision: 32 bytes, since there are many.
struct Piece
{
	Point3f middle; ///< the mean of its corners, in the coordinates of its PiecesByCell
	float area;     ///< in squares of their unit
	Point3f normal; ///< unit length, or zero
	int face;
};

/// The triangles of a component of a stage in pieces, in the order of the cells of a grid.
class PiecesByCell
{
public:
	struct Cell
	{
		std::int64_t number;
		int first, last; ///< its pieces: from first to last - 1
		/// Bounds of the middles and of the normals.
		Point3f lowest, highest, minNormal, greatestNormal;
		double area;
	};

	Point3d origin;
	/// The unit of `inside()` coordinates, mesh units: a power of two of the size of an epsilon, or
	/// of the rounding of the box where that is larger. Squares stay within the range of single
	/// precision, and dividing by it changes no digit.
	double unit;
	std::vector<Piece> pieces;
	std::vector<Cell> cells;

	Point3f inside(const Point3d& p) const { return Point3f::Construct((p - origin) / unit); }

	/**
	 * Halves each triangle at its longest edge until no edge is longer than longestPiece, at most
	 * 16 times; less often where that would give millions of pieces, as with an epsilon far below
	 * the edges.
	 * @param faces    of the component.
	 * @param box      of its vertices.
	 * @param epsilon  mesh units.
	 * @throws Cancelled
	 */
	PiecesByCell(const SurfaceMesh& mesh, const std::vector<int>& faces, const Box3d& box,
		const CellGrid& grid, double epsilon, const Progress& progress) :
			origin(box.Center()),
			unit(unitOf(epsilon, box))
	{
		const double longest = longestPiece * epsilon;
		const int halvings = maxHalvings(mesh, faces, longest, progress.part(0, 0.05));
		std::vector<Piece> unsorted;
		unsorted.reserve(faces.size());
		reportedLoop(int(faces.size()), progress.part(0.05, 0.3), tellingKinds, [&](int i) {
			const int f = faces[size_t(i)];
			const Triangle t = mesh.triangle(f);
			const std::array<Point3d, 3> corners = {
				mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]};
			const Point3d doubleAreaVector = mesh.doubleAreaVector(f);
			const double length = doubleAreaVector.Norm();
			Piece whole {{0, 0, 0}, float(length / 2 / unit / unit), {0, 0, 0}, f};
			if (length > 0)
				whole.normal = Point3f::Construct(doubleAreaVector / length);
			addPieces(unsorted, whole, corners, longest, halvings);
		});
		const PointsByCell sorted(
			int(unsorted.size()),
			[&](int i) { return Point3d::Construct(unsorted[size_t(i)].middle) * unit + origin; },
			grid, progress.part(0.3, 0.8), tellingKinds);
		pieces.reserve(unsorted.size());
		reportedLoop(int(unsorted.size()), progress.part(0.8, 1), tellingKinds, [&](int i) {
			const Piece& piece = unsorted[size_t(sorted.id[size_t(i)])];
			if (cells.empty() || cells.back().number != sorted.cell[size_t(i)])
				cells.push_back({sorted.cell[size_t(i)], i, i, piece.middle, piece.middle,
					piece.normal, piece.normal, 0});
			Cell& cell = cells.back();
			++cell.last;
			for (int axis = 0; axis < 3; ++axis) {
				cell.lowest[axis] = std::min(cell.lowest[axis], piece.middle[axis]);
				cell.highest[axis] = std::max(cell.highest[axis], piece.middle[axis]);
				cell.minNormal[axis] = std::min(cell.minNormal[axis], piece.normal[axis]);
				cell.greatestNormal[axis] = std::max(cell.greatestNormal[axis], piece.normal[axis]);
			}
			cell.area += piece.area;
			pieces.push_back(piece);
		});
	}

private:
	static double unitOf(double epsilon, const Box3d& box)
	{
		constexpr double rounding = 1e-15; // of the box's diagonal
		const double size = std::max(epsilon, rounding * box.Diag());
		return size > 0 ? std::exp2(std::ilogb(size)) : 1;
	}

	/// How often a triangle may be halved. Two halvings halve its longest edge.
	static int maxHalvings(const SurfaceMesh& mesh, const std::vector<int>& faces, double longest,
		const Progress& progress)
	{
		constexpr int maximum = 16;
		// All components together have as many as a single one would.
		const double maxPieces =
			double(faces.size()) * std::max(double(1 << 22) / mesh.faceSlots(), 64.0);
		std::array<double, maximum + 1> triangles = {}; // by the halvings that they need
		reportedLoop(int(faces.size()), progress, tellingKinds, [&](int i) {
			const int h = 3 * faces[size_t(i)];
			const double length = std::sqrt(std::max(
				{mesh.squaredLength(h), mesh.squaredLength(h + 1), mesh.squaredLength(h + 2)}));
			const double ratio = length / longest;
			++triangles[size_t(std::clamp(std::ceil(2 * std::log2(ratio)), 0.0, double(maximum)))];
		});
		const auto pieces = [&](int halvings) {
			double count = 0;
			for (int k = 0; k <= maximum; ++k)
				count += triangles[size_t(k)] * std::exp2(std::min(k, halvings));
			return count;
		};
		int halvings = maximum;
		while (halvings > 0 && pieces(halvings) > maxPieces)
			--halvings;
		return halvings;
	}

	void addPieces(std::vector<Piece>& found, const Piece& whole,
		const std::array<Point3d, 3>& corners, double longest, int halvings) const
	{
		const auto& [a, b, c] = corners;
		const double ab = SquaredDistance(a, b), bc = SquaredDistance(b, c),
					 ca = SquaredDistance(c, a);
		if (bc > ab && bc >= ca)
			return addPieces(found, whole, {b, c, a}, longest, halvings);
		if (ca > ab)
			return addPieces(found, whole, {c, a, b}, longest, halvings);
		if (ab > longest * longest && halvings > 0) {
			Piece half = whole;
			half.area /= 2;
			const Point3d middle = (a + b) / 2.0;
			addPieces(found, half, {b, c, middle}, longest, halvings - 1);
			addPieces(found, half, {c, a, middle}, longest, halvings - 1);
			return;
		}
		found.push_back(whole);
		found.back().middle = inside((a + b + c) / 3.0);
	}
};

/// The cells around one that moves forward through a grid.
class CellsAround
{
public:
	CellsAround(const std::vector<PiecesByCell::Cell>& cells, std::int64_t start) : cells(cells)
	{
		for (size_t i = 0; i < rows.size(); ++i) {
			const std::int64_t from = start + rowOf(i) - 2;
			next[i] = std::lower_bound(cells.begin(), cells.end(), from,
						  [](const PiecesByCell::Cell& c, std::int64_t n) { return c.number < n; })
				- cells.begin();
		}
	}

	/// Those within `distance` cells, 1 or 2, of `middle`, which only grows from call to call.
	void find(std::int64_t middle, int distance, std::vector<int>& found)
	{
		found.clear();
		const size_t count = distance == 1 ? 9 : rows.size();
		for (size_t i = 0; i < count; ++i) {
			const std::int64_t centre = middle + rowOf(i);
			std::ptrdiff_t& at = next[i];
			const std::ptrdiff_t end = std::ptrdiff_t(cells.size());
			while (at < end && cells[size_t(at)].number < centre - 2)
				++at;
			for (std::ptrdiff_t c = at; c < end && cells[size_t(c)].number <= centre + distance;
				 ++c)
				if (cells[size_t(c)].number >= centre - distance)
					found.push_back(int(c));
		}
	}

private:
	/// Rows of cells along x by their steps in y and z, the nearest first.
	static constexpr std::array<std::array<int, 2>, 25> rows = {
		{{0, 0}, {0, -1}, {0, 1}, {-1, 0}, {1, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}, {-2, 0},
			{2, 0}, {0, -2}, {0, 2}, {-2, -1}, {-2, 1}, {2, -1}, {2, 1}, {-1, -2}, {1, -2}, {-1, 2},
			{1, 2}, {-2, -2}, {-2, 2}, {2, -2}, {2, 2}}};

	const std::vector<PiecesByCell::Cell>& cells;
	std::array<std::ptrdiff_t, 25> next;

	static std::int64_t rowOf(size_t i)
	{
		return rows[i][0] * CellGrid::nextRow + rows[i][1] * CellGrid::nextLayer;
	}
};

/// Looks for a wall that faces a vertex and is no farther from it than maxThickness.
class OppositeWall
{
public:
	OppositeWall(
		const Stage& stage, const PiecesByCell& surface, int v, const Point3d& vertexNormal) :
			mesh(stage.mesh),
			surface(surface), place(mesh.position[v]), limit(maxThickness * epsilonAt(stage, v)),
			middle(surface.inside(place)), normal(Point3f::Construct(vertexNormal)),
			height(float(limit * roomForRounding / surface.unit))
	{
		const double reach = wallReach * epsilonAt(stage, v) * roomForRounding / surface.unit;
		squaredReach = float(reach * reach);
	}

	/// Whether a piece belongs to such a wall.
	bool isIn(int i) const
	{
		const Piece& piece = surface.pieces[size_t(i)];
		const Point3f d = piece.middle - middle;
		// One branch for three unpredictable tests: most are turned alike, far, or in a far plane.
		if (int(piece.normal * normal > opposite) | int(std::abs(d * piece.normal) > height)
			| int(d.SquaredNorm() > squaredReach))
			return false;
		return squaredDistance(mesh.position, mesh.triangle(piece.face), place) <= limit * limit;
	}

	/// A piece of these cells that is such a wall; -1 if there is none.
	int findIn(const std::vector<int>& cells) const
	{
		for (int c : cells) {
			const PiecesByCell::Cell& cell = surface.cells[size_t(c)];
			float minimum = 0;
			for (int axis = 0; axis < 3; ++axis)
				minimum += std::min(
					normal[axis] * cell.minNormal[axis], normal[axis] * cell.greatestNormal[axis]);
			if (minimum > opposite)
				continue;
			for (int i = cell.first; i < cell.last; ++i)
				if (isIn(i))
					return i;
		}
		return -1;
	}

private:
	static constexpr float opposite = -0.2f; // cosine: no neighbour round an edge of a box
	static constexpr double roomForRounding = 1.01;

	const SurfaceMesh& mesh;
	const PiecesByCell& surface;
	Point3d place;
	double limit;
	Point3f middle, normal;
	float height, squaredReach;
};

/// Whether the pieces of some cells with middles in a ball have at least the area `enough` in all.
/// @param radius, enough in mesh units, and their square.
inline bool hasAreaWithin(const PiecesByCell& surface, const std::vector<int>& cells,
	const Point3d& centre, double radius, double enough)
{
	const Point3f middle = surface.inside(centre);
	radius /= surface.unit;
	enough /= surface.unit * surface.unit;
	const float squaredRadius = float(radius * radius);
	double area = 0;
	for (int c : cells) {
		const PiecesByCell::Cell& cell = surface.cells[size_t(c)];
		float nearest = 0, farthest = 0; // squared distances of the box
		for (int axis = 0; axis < 3; ++axis) {
			const float below = cell.lowest[axis] - middle[axis],
						above = middle[axis] - cell.highest[axis];
			const float gap = std::max({below, above, 0.f}), far = std::min(below, above);
			nearest += gap * gap;
			farthest += far * far;
		}
		if (nearest >= squaredRadius)
			continue;
		if (farthest < squaredRadius)
			area += cell.area;
		else
			for (int i = cell.first; i < cell.last; ++i) {
				const Piece& piece = surface.pieces[size_t(i)];
				area += SquaredDistance(piece.middle, middle) < squaredRadius ? piece.area : 0;
			}
		if (area >= enough)
			return true;
	}
	return false;
}

/// Whether a vertex has an opposite wall, in one of the cells or among `recent`.
/// @param recent  pieces of walls of vertices nearby, one of which is often this vertex's too.
inline bool hasOppositeWall(
	const OppositeWall& wall, const std::vector<int>& cells, std::array<int, 4>& recent)
{
	const auto isWall = [&](int i) { return wall.isIn(i); };
	if (std::any_of(recent.begin(), recent.end(), isWall))
		return true;
	const int found = wall.findIn(cells);
	if (found < 0)
		return false;
	std::rotate(recent.begin(), recent.end() - 1, recent.end());
	recent[0] = found;
	return true;
}

/**
 * Decides between sheet and curve for the last vertex of `closed` and for those near it that must
 * be of the same kind, and removes these from `closed`.
 * @param cells   the cells within two of that of the vertices.
 * @param closed  vertices of one cell on which the surface has closed.
 */
inline void tellSomeKinds(const Stage& stage, const PiecesByCell& surface,
	const std::vector<int>& cells, std::vector<int>& closed, std::vector<VertexKind>& kind)
{
	constexpr double minSheet = 0.27; // of 2 pi R^2
	const int v = closed.back();
	const Point3d& centre = stage.mesh.position[v];
	const double epsilon = epsilonAt(stage, v), R = sheetReach * epsilon;
	const auto isSheet = [&](double radius) {
		return hasAreaWithin(surface, cells, centre, radius, minSheet * 2 * M_PI * R * R);
	};
	double d = 0;
	const auto isApart = [&](int w) {
		const double distance = Distance(stage.mesh.position[w], centre);
		if (distance > toldTogether * epsilon)
			return true;
		d = std::max(d, distance);
		return false;
	};
	auto some = std::partition(closed.begin(), closed.end(), isApart);
	VertexKind told = VertexKind::Sheet;
	if (!isSheet(R - d)) {
		told = VertexKind::Curve;
		if (d > 0 && isSheet(R + d)) { // they may differ
			some = std::partition(some, closed.end(), [&](int w) { return w != v; });
			told = isSheet(R) ? VertexKind::Sheet : VertexKind::Curve;
		}
	}
	for (auto w = some; w != closed.end(); ++w)
		kind[*w] = told;
	closed.erase(some, closed.end());
}

/// For each vertex the kind of more than half of it and its neighbours, else its own.
inline std::vector<VertexKind> majority(
	const SurfaceMesh& mesh, const std::vector<VertexKind>& kind, const Progress& progress)
{
	// A vertex whose triangles are each of one kind keeps it.
	std::vector<char> mixed(kind.size(), 0);
	reportedLoop(mesh.faceSlots(), progress.part(0, 0.7), tellingKinds, [&](int f) {
		const Triangle t = mesh.triangle(f);
		if (kind[t[0]] != kind[t[1]] || kind[t[1]] != kind[t[2]])
			mixed[t[0]] = mixed[t[1]] = mixed[t[2]] = 1;
	});
	std::vector<VertexKind> result = kind;
	reportedLoop(mesh.vertexSlots(), progress.part(0.7, 1), tellingKinds, [&](int v) {
		if (!mixed[v])
			return;
		std::array<int, 3> votes = {0, 0, 0};
		int all = 1;
		++votes[size_t(kind[v])];
		mesh.forEachOutgoing(v, [&](int h) {
			++votes[size_t(kind[mesh.target(h)])];
			++all;
		});
		for (size_t k = 0; k < votes.size(); ++k)
			if (2 * votes[k] > all)
				result[v] = VertexKind(k);
	});
	return result;
}

} // namespace detail

/**
 * The kind of each vertex of a stage.
 *
 * Each component is treated by itself, with its own epsilon.
 * Volume: a vertex that is not fixed by the flow and has no wall opposite, turned the other way,
 * within 2 epsilon; on which side does not matter, since walls may have passed each other. Of the
 * others, on which the surface has closed, sheets are told from curves by the area of the stage
 * within a ball of R = 8 epsilon, both walls counted: 2 pi R^2 in the middle of a sheet, half of
 * that at its rim, and for a curve, a tube no wider than epsilon, at most 2 R epsilon pi. A sheet
 * has at least 0.27 of the full area; a strip narrower than about 3.4 epsilon is a curve. Three
 * rounds of majority among neighbours remove kinds of single vertices.
 *
 * The area is that of pieces of triangles with no edge longer than 4 epsilon. Pieces and vertices
 * are sorted into cells: walls are searched in the 27 cells around a vertex, areas in 125. The
 * balls of vertices within d of one of them all hold its ball of R - d and lie in that of R + d: if
 * the first has enough, all are sheets, if the second has not, all are curves.
 *
 * @return the kind of each vertex. @pre stage.mesh is compact. @throws Cancelled
 * Complexity: O(V) where no edge is much shorter than epsilon. Source: ours; the paper shows kinds,
 * but does not say how to tell them.
 */
inline std::vector<VertexKind> vertexKinds(
	const Stage& stage, const Progress& progress = Progress())
{
	constexpr int rounds = 3;
	const SurfaceMesh& mesh = stage.mesh;
	const std::vector<Point3d> normal = mesh.vertexNormals(progress.part(0, 0.1));
	std::vector<VertexKind> kind(size_t(mesh.vertexSlots()), VertexKind::Volume);
	const int components = int(stage.diagonal.size());
	const ComponentVertices vertices(stage.component, components, progress.cancelOnly());
	std::vector<std::vector<int>> faces(vertices.ids.size());
	detail::cancellableLoop(mesh.faceSlots(), progress,
		[&](int f) { faces[size_t(stage.component[mesh.origin(3 * f)])].push_back(f); });
	int done = 0;
	for (int c = 0; c < components; ++c) {
		const std::vector<int>& own = vertices.ids[size_t(c)];
		const int count = int(own.size());
		const auto bar = [&](int told) {
			return 0.1 + 0.8 * told / std::max(mesh.vertexSlots(), 1);
		};
		const Progress part = progress.part(bar(done), bar(done + count));
		done += count;
		const double epsilon = stage.epsilon * stage.diagonal[size_t(c)];
		Box3d box;
		detail::cancellableLoop(
			count, part, [&](int i) { box.Add(mesh.position[own[size_t(i)]]); });
		const detail::CellGrid grid(box, detail::kindCell * epsilon);
		const detail::PointsByCell sorted(
			count, [&](int i) { return mesh.position[own[size_t(i)]]; }, grid, part.part(0, 0.1),
			detail::tellingKinds);
		const detail::PiecesByCell surface(
			mesh, faces[size_t(c)], box, grid, epsilon, part.part(0.1, 0.4));
		const auto cells = [&](int begin, int end) {
			detail::CellsAround around(surface.cells, sorted.cell[begin]);
			std::vector<int> near, closed;
			std::array<int, 4> recent = {0, 0, 0, 0}; // pieces of walls of vertices nearby
			while (begin < end) {
				const std::int64_t cell = sorted.cell[begin];
				around.find(cell, 1, near);
				closed.clear();
				for (; begin < end && sorted.cell[begin] == cell; ++begin) {
					const int v = own[size_t(sorted.id[begin])];
					if ((stage.fixed[v] && !stage.held[v])
						|| detail::hasOppositeWall(
							detail::OppositeWall(stage, surface, v, normal[v]), near, recent))
						closed.push_back(v);
				}
				if (!closed.empty())
					around.find(cell, 2, near);
				while (!closed.empty())
					detail::tellSomeKinds(stage, surface, near, closed, kind);
			}
		};
		forEachBlock(count, part.part(0.4, 1), detail::tellingKinds, cells);
	}
	for (int i = 0; i < rounds; ++i)
		kind = detail::majority(mesh, kind, progress.part(0.9, 1));
	return kind;
}

} // namespace vcg::tri::mcf

#endif
