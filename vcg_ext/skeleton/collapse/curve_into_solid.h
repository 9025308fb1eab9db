// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A component of a curve is brought into its solid, or what is outside is cut off.

#ifndef VCG_MCF_CURVE_INTO_SOLID_H
#define VCG_MCF_CURVE_INTO_SOLID_H

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>
#include <skeleton/spatial/solid_test.h>
#include <skeleton/spatial/surface_ways.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// How far outside a curve may be, of the diagonal: by the rounding of the shape's coordinates, see
/// PrincipalFrame::onGrid().
constexpr double promisedTolerance = 5e-7;
/// How far outside the sampled places may be: those between them may be twice as far.
constexpr double outsideTolerance = promisedTolerance / 2;

/// A component of a curve on its way into its solid, in the coordinates of the SolidTest.
class CurveIntoSolid
{
public:
	/// @param place of each node. @param edges pairs of nodes.
	/// @param tolerance how far outside a point may be.
	CurveIntoSolid(const SolidTest& solid, std::vector<Point3d> place,
		std::vector<std::array<int, 2>> edges, const Progress& progress,
		double tolerance = outsideTolerance) :
			solid(solid),
			place(std::move(place)), edges(std::move(edges)), progress(progress),
			tolerance(tolerance)
	{
	}

	/// For each node the vertices of the surface that have merged into it; empty if not known.
	std::vector<std::vector<int>> merged;

	const std::vector<Point3d>& places() const { return place; }
	/// 1 for nodes that have moved or are new. New ones follow those that were given.
	const std::vector<char>& changedNodes() const { return changed; }
	const std::vector<std::array<int, 2>>& curveEdges() const { return edges; }

	enum class Outcome {
		AllInside, ///< already
		Brought,
		TooLong, ///< nodes are inside, edges are not: the detours would be too long
	};

	/**
	 * Moves nodes that are outside, then bends the edges that are; not if both together would make
	 * the curve longer than twice its length plus three diagonals, as where a surface runs into
	 * itself all over.
	 * @throws SolverError if something is still outside; Cancelled.
	 */
	Outcome bringInside()
	{
		changed.assign(place.size(), 0);
		std::vector<char> isOutside(place.size(), 0);
		bool any = false;
		for (size_t A = 0; A < place.size(); ++A) {
			report();
			isOutside[A] = !solid.isInside(place[A], tolerance);
			any |= isOutside[A];
		}
		if (!any && allInside())
			return Outcome::AllInside;
		const double maxLength = longerOfCurve * length() + longerOfDiagonal;
		std::vector<std::vector<int>> neighbours(place.size());
		for (const auto& [A, B] : edges) {
			neighbours[A].push_back(B);
			neighbours[B].push_back(A);
		}
		for (size_t A = 0; A < place.size(); ++A)
			if (isOutside[A])
				moveInside(int(A), neighbours);
		return bendEdges(maxLength) ? Outcome::Brought : Outcome::TooLong;
	}

	/**
	 * Removes subtrees that are attached by an edge outside; in a tree, all but the longest part
	 * inside. Edges of cycles, and of paths between cycles, are bent however long that makes them.
	 * @pre bringInside() has returned TooLong.
	 * @return for each node the one that takes its place: itself, or the nearest along the tree
	 *         that is left.
	 * @throws SolverError if something is still outside; Cancelled.
	 */
	std::vector<int> cutOff()
	{
		const int n = int(place.size());
		std::vector<std::vector<int>> all(place.size()), inner(place.size());
		for (const auto& edge : edges) {
			const bool isInner = segmentIsInside(place[edge[0]], place[edge[1]]);
			for (int k = 0; k < 2; ++k) {
				all[edge[k]].push_back(edge[1 - k]);
				if (isInner)
					inner[edge[k]].push_back(edge[1 - k]);
			}
		}
		std::vector<int> degree, leafs;
		for (int A = 0; A < n; ++A) {
			degree.push_back(int(all[A].size()));
			if (degree[A] <= 1)
				leafs.push_back(A);
		}
		std::vector<char> kept(place.size(), 1);
		while (!leafs.empty()) {
			const int A = leafs.back();
			leafs.pop_back();
			kept[A] = 0;
			for (int B : all[A])
				if (--degree[B] == 1)
					leafs.push_back(B);
		}
		std::vector<int> seeds;
		for (int A = 0; A < n; ++A)
			if (kept[A])
				seeds.push_back(A);
		if (seeds.empty())
			seeds.push_back(longestPart(inner));
		const auto reach = [&](const std::vector<std::vector<int>>& over, const auto& visit) {
			for (size_t i = 0; i < seeds.size(); ++i)
				for (int B : over[seeds[i]])
					visit(seeds[i], B);
		};
		for (int A : seeds)
			kept[A] = 1;
		reach(inner, [&](int, int B) {
			if (!kept[B]) {
				kept[B] = 1;
				seeds.push_back(B);
			}
		});
		std::vector<int> heir(place.size(), -1);
		for (int A : seeds)
			heir[A] = A;
		reach(all, [&](int A, int B) {
			if (heir[B] < 0) {
				heir[B] = heir[A];
				seeds.push_back(B);
			}
		});
		const auto isCut = [&](const std::array<int, 2>& edge) {
			return !kept[edge[0]] || !kept[edge[1]];
		};
		edges.erase(std::remove_if(edges.begin(), edges.end(), isCut), edges.end());
		bendEdges(std::numeric_limits<double>::infinity());
		return heir;
	}

private:
	using Path = std::vector<Point3d>;

	/// How long bending may make a curve: so many times its length plus so many diagonals.
	static constexpr double longerOfCurve = 2, longerOfDiagonal = 3;

	static double lengthOf(const Path& between, const Point3d& first, const Point3d& last)
	{
		double length = 0;
		const Point3d* from = &first;
		for (const Point3d& p : between) {
			length += Distance(*from, p);
			from = &p;
		}
		return length + Distance(*from, last);
	}

	double length() const
	{
		double sum = 0;
		for (const auto& [A, B] : edges)
			sum += Distance(place[A], place[B]);
		return sum;
	}

	bool allInside() const
	{
		return std::all_of(edges.begin(), edges.end(), [&](const std::array<int, 2>& edge) {
			return segmentIsInside(place[edge[0]], place[edge[1]]);
		});
	}

	/// Bends the edges that are outside. @return false, with nothing changed, if the curve would
	/// become longer than maxLength. @throws SolverError if something is still outside.
	bool bendEdges(double maxLength)
	{
		const size_t nodes = place.size();
		double bentLength = length();
		std::vector<std::array<int, 2>> bent;
		for (const auto& edge : edges) {
			const Point3d from = place[edge[0]], to = place[edge[1]];
			if (segmentIsInside(from, to)) {
				bent.push_back(edge);
				continue;
			}
			const Path way = inside(from, to);
			bentLength += lengthOf(way, from, to) - Distance(from, to);
			if (!(bentLength <= maxLength)) {
				place.resize(nodes);
				changed.resize(nodes);
				return false;
			}
			int last = edge[0];
			for (const Point3d& p : way) {
				const int next = int(place.size());
				place.push_back(p);
				changed.push_back(1);
				bent.push_back({last, next});
				last = next;
			}
			bent.push_back({last, edge[1]});
		}
		edges = std::move(bent);
		if (!allInside())
			throw SolverError("The curve could not be brought inside the shape.");
		return true;
	}

	/// A node of the connected component of a graph on the places that has the greatest length.
	int longestPart(const std::vector<std::vector<int>>& neighbours) const
	{
		std::vector<char> seen(place.size(), 0);
		double maximum = -1;
		int best = 0;
		for (size_t first = 0; first < place.size(); ++first) {
			if (seen[first])
				continue;
			double length = 0; // each edge counts twice
			std::vector<int> part(1, int(first));
			seen[first] = 1;
			for (size_t i = 0; i < part.size(); ++i)
				for (int B : neighbours[part[i]]) {
					length += Distance(place[part[i]], place[B]);
					if (!seen[B]) {
						seen[B] = 1;
						part.push_back(B);
					}
				}
			if (length > maximum) {
				maximum = length;
				best = int(first);
			}
		}
		return best;
	}

	const SolidTest& solid;
	std::vector<Point3d> place;
	std::vector<std::array<int, 2>> edges;
	const Progress& progress;
	double tolerance;
	std::vector<char> changed;
	/// Made when it is first needed.
	std::optional<SurfaceWays> overSurface;

	void report() const { progress.report(0, "Bringing the curve inside"); }

	bool segmentIsInside(const Point3d& p, const Point3d& q) const
	{
		report();
		return solid.segmentIsInside(p, q, tolerance);
	}

	/// Half a chord of the solid: from a point of the surface to the middle of the chord.
	struct HalfChord
	{
		Point3d from, along;
		Point3d at(double part) const { return from + along * part; }
	};

	HalfChord halfChord(const Point3d& from, const Point3d& direction) const
	{
		const HalfChord half = {from, direction * (solid.chord(from, direction).distance / 2)};
		return solid.isInside(half.at(1)) ? half : HalfChord {from, Point3d(0, 0, 0)};
	}

	/// The half chord from the closest point of the surface, on the line through both points, or its
	/// part up to the centre of the ball that touches there, see shrunk(): from the rim of a plate,
	/// the middle of the chord is in the middle of the plate.
	HalfChord closestChord(const Point3d& point, bool isOutside) const
	{
		const SolidTest::Closest on = solid.closest(point);
		return on.distance > 0 ? shrunk(halfChord(
				   on.point, (isOutside ? on.point - point : point - on.point) / on.distance))
							   : HalfChord {on.point, Point3d(0, 0, 0)};
	}

	/// About the radius of the maximal ball that touches where a half chord starts: the ball shrinks
	/// until no surface is clearly inside (Ma, Bae and Choi 2012). In a faceted tube none is. What it
	/// meets less than a radius from where it touches is the same wall, or the other side of an edge,
	/// as along a blade: a ball between both would be in the edge.
	HalfChord shrunk(HalfChord half) const
	{
		constexpr double near = 0.75; // radii
		constexpr int maxRounds = 16;
		for (int round = 0; round < maxRounds; ++round) {
			const double radius = half.along.Norm();
			const SolidTest::Closest contact = solid.closest(half.at(1));
			const Point3d to = contact.point - half.from;
			if (contact.distance >= near * radius || to.Norm() < radius)
				break;
			const double part = to.SquaredNorm() / (2 * (to * half.along));
			if (!(part > 0 && part < 1) || !solid.isInside(half.at(part)))
				break;
			half.along *= part;
		}
		return half;
	}

	const SurfaceWays& ways()
	{
		constexpr double spacing = 1.0 / 32; // of the diagonal
		if (!overSurface)
			overSurface.emplace(solid.vertices(), solid.triangles(), spacing, progress);
		return *overSurface;
	}

	HalfChord chordAt(const SurfaceWays::Place& place) const
	{
		return place.inward.SquaredNorm() > 0 ? halfChord(place.point, place.inward)
											  : HalfChord {place.point, Point3d(0, 0, 0)};
	}

	/**
	 * Moves a node to the middle of a chord: that from the nearest point of the surface if it is
	 * next to the node, else of those from the triangles at the vertices that have merged into it
	 * the one whose middle is nearest. Not to the place of a neighbour, so that no edge has length 0.
	 */
	void moveInside(int A, const std::vector<std::vector<int>>& neighbours)
	{
		constexpr double nextTo = 0.004; // two of the default epsilon
		constexpr size_t maxTried = 32;
		HalfChord best = closestChord(place[A], true);
		if (Distance(best.from, place[A]) > nextTo && !merged.empty() && !merged[A].empty()) {
			const size_t step = (merged[A].size() + maxTried - 1) / maxTried;
			double nearest = std::numeric_limits<double>::infinity();
			for (size_t i = 0; i < merged[A].size(); i += step)
				for (int f : ways().facesAtVertex(merged[A][i])) {
					const HalfChord candidate = chordAt(ways().closestIn(f, place[A]));
					const double distance = SquaredDistance(candidate.at(1), place[A]);
					if (distance < nearest && candidate.along.SquaredNorm() > 0) {
						nearest = distance;
						best = candidate;
					}
				}
			best = shrunk(best);
		}
		const auto takenBy = [&](const Point3d& p) {
			return std::find_if(neighbours[A].begin(), neighbours[A].end(),
				[&](int B) { return isSame(place[B], p); });
		};
		const auto isFree = [&](const Point3d& p) { return takenBy(p) == neighbours[A].end(); };
		double part = 1;
		for (int i = 0; i < 20 && !isFree(best.at(part)); ++i)
			part *= 0.9;
		Point3d moved = best.at(part);
		// In a corner chords have no length: there, halfway from the neighbour to another node.
		if (const auto there = takenBy(moved); there != neighbours[A].end())
			for (const std::vector<int>& others : {neighbours[A], neighbours[*there]})
				for (int C : others) {
					if (C == A || isFree(moved))
						continue;
					const Point3d middle = (place[*there] + place[C]) / 2;
					const Point3d between =
						solid.isInside(middle) ? middle : closestChord(middle, true).at(1);
					if (isFree(between))
						moved = between;
				}
		place[A] = moved;
		changed[A] = 1;
	}

	/// New nodes between two others whose edge is outside somewhere.
	Path inside(const Point3d& p, const Point3d& q)
	{
		constexpr int deepest = 5;
		Path between;
		for (const Halving halving : {Halving::MovesOutside, Halving::MovesAll}) {
			between.clear();
			if (bisected(p, q, halving, deepest, between)) {
				simplify(p, q, between);
				return between;
			}
		}
		between = alongSurface(p, q);
		simplify(p, q, between);
		return between;
	}

	/// Which midpoints of the segments that bisected() halves go to the middle of a chord.
	enum class Halving {
		MovesOutside,
		MovesAll, ///< at a corner of two thin walls, midpoints that are inside converge to it
	};

	/// Halves the segment until its parts are inside. @param between receives the points added.
	/// @return whether that takes at most so many levels.
	bool bisected(
		const Point3d& p, const Point3d& q, Halving halving, int levels, Path& between) const
	{
		if (segmentIsInside(p, q))
			return true;
		if (levels == 0)
			return false;
		Point3d middle = (p + q) / 2;
		const bool isOutside = !solid.isInside(middle);
		if (isOutside || halving == Halving::MovesAll)
			middle = closestChord(middle, isOutside).at(1);
		if (middle == p || middle == q || !bisected(p, middle, halving, levels - 1, between))
			return false;
		between.push_back(middle);
		return bisected(middle, q, halving, levels - 1, between);
	}

	/// A point of the surface, and its triangle.
	struct OnSurface
	{
		Point3d point;
		int face;
	};

	/// The nearest point of the surface, and for a point inside the one on its other side.
	std::vector<OnSurface> wallsAt(const Point3d& p) const
	{
		const SolidTest::Closest on = solid.closest(p);
		std::vector<OnSurface> walls(1, {on.point, on.face});
		if (on.distance > 0 && solid.isInside(p)) {
			const Point3d across = (p - on.point) / on.distance;
			const SolidTest::Crossing other = solid.chord(on.point, across);
			const Point3d there = on.point + across * other.distance;
			// For a point that is on the surface up to rounding, `across` is arbitrary.
			if (other.face >= 0 && segmentIsInside(p, there))
				walls.push_back({there, other.face});
		}
		return walls;
	}

	/**
	 * A way that always exists: straight to the surface, over its triangles, and back. Of the two
	 * walls of a sheet both ends take the same one: around the rim it may be far. Between them the
	 * way is lifted off the surface, to the middle of the chords, but no higher than the ends are:
	 * from the rim of a sheet chords lead far through it.
	 */
	Path alongSurface(const Point3d& p, const Point3d& q)
	{
		const OnSurface first = wallsAt(p).front();
		const double height = Distance(p, first.point);
		Path shortest;
		double minimum = std::numeric_limits<double>::infinity();
		for (const OnSurface& last : wallsAt(q)) {
			Path path = alongSurface(first, last, std::max(height, Distance(q, last.point)));
			const double length = lengthOf(path, p, q);
			if (length < minimum) {
				minimum = length;
				shortest = std::move(path);
			}
		}
		return shortest;
	}

	/// The same between given points of the surface, lifted by up to `height` if it stays inside.
	Path alongSurface(const OnSurface& first, const OnSurface& last, double height)
	{
		Path path(1, first.point);
		HalfChord before = {first.point, Point3d(0, 0, 0)};
		for (const SurfaceWays::Place& place :
			ways().way(first.face, first.point, last.face, last.point)) {
			HalfChord here = chordAt(place);
			if (const double length = here.along.Norm(); length > height)
				here.along *= height / length;
			double part = 1;
			constexpr double lowest = 1e-3;
			while (part > 0 && !segmentIsInside(before.at(part), here.at(part)))
				part = part > lowest ? part / 2 : 0;
			path.push_back(before.at(part));
			path.push_back(here.at(part));
			path.push_back(here.at(1));
			before = here;
		}
		path.push_back(before.from);
		path.push_back(last.point);
		return path;
	}

	/// Whether two places are the same, be it after rounding to mesh units.
	bool isSame(const Point3d& p, const Point3d& q) const
	{
		constexpr double rounding = 1e-12;
		return Distance(p, q) <= rounding || solid.out(p) == solid.out(q);
	}

	/// Removes points without which the way is inside as well, and repeated ones.
	void simplify(const Point3d& p, const Point3d& q, Path& between) const
	{
		constexpr int rounds = 4;
		for (int round = 0; round < rounds; ++round) {
			Path kept;
			const size_t count = between.size();
			for (size_t i = 0; i < count; ++i) {
				const Point3d& before = kept.empty() ? p : kept.back();
				const Point3d& after = i + 1 < count ? between[i + 1] : q;
				if (isSame(before, between[i]) || isSame(between[i], after))
					continue;
				if (before == after || !segmentIsInside(before, after))
					kept.push_back(between[i]);
			}
			if (kept.size() == count)
				return;
			between = std::move(kept);
		}
	}
};

} // namespace detail

} // namespace vcg::tri::mcf

#endif
