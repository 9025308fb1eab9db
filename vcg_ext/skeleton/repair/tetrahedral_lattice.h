// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A sparse body-centred cubic lattice of tetrahedra: only the nodes in use are stored.

#ifndef VCG_MCF_TETRAHEDRAL_LATTICE_H
#define VCG_MCF_TETRAHEDRAL_LATTICE_H

#include <vcg/space/point3.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The nodes of a cubic lattice and the centres of its cubes. Each node has 14 neighbours: 6 at the
 * spacing a along the axes, 8 at sqrt(3) / 2 a along the diagonals of the cubes. The tetrahedra are
 * congruent, with two opposite edges along axes; each ball of radius sqrt(5) / 4 a contains a node.
 *
 * Coordinates are integers in units of a / 2: all even, or all odd.
 */
class TetrahedralLattice
{
public:
	using Place = std::array<int, 3>;
	/// Directions to the neighbours; d + 7 is opposite to d, for d < 7.
	static constexpr int directions = 14, forward = 7;

	/// @param origin of the coordinates, and @param spacing a, mesh units.
	TetrahedralLattice(const Point3d& origin, double spacing) :
			origin(origin), half(spacing / 2), table(size_t(1) << 12, -1)
	{
	}

	int size() const { return int(places.size()); }
	double spacing() const { return 2 * half; }
	const Place& place(int node) const { return places[size_t(node)]; }
	Point3d position(const Place& at) const { return origin + Point3d(at[0], at[1], at[2]) * half; }
	Point3d position(int node) const { return position(place(node)); }
	/// -1 if that node does not exist.
	int neighbour(int node, int direction) const
	{
		return neighbours[size_t(node)][size_t(direction)];
	}

	/// The step of a direction: 0 to 2 along the axes, 3 to 6 along the diagonals with z rising.
	static Place step(int direction)
	{
		static constexpr int steps[forward][3] = {
			{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}, {1, 1, 1}};
		const int* s = steps[direction % forward];
		const int sign = direction < forward ? 1 : -1;
		return {sign * s[0], sign * s[1], sign * s[2]};
	}
	static int opposite(int direction) { return (direction + forward) % directions; }
	static Place moved(const Place& from, int direction)
	{
		const Place s = step(direction);
		return {from[0] + s[0], from[1] + s[1], from[2] + s[2]};
	}

	/// The node at a place, made if it does not exist.
	int add(const Place& at)
	{
		if (const int found = find(at); found >= 0)
			return found;
		if (3 * (places.size() + 1) > 2 * table.size())
			grow();
		const int node = int(places.size());
		places.push_back(at);
		enter(node);
		std::array<int, directions> around;
		for (int d = 0; d < directions; ++d) {
			around[size_t(d)] = find(moved(at, d));
			if (around[size_t(d)] >= 0)
				neighbours[size_t(around[size_t(d)])][size_t(opposite(d))] = node;
		}
		neighbours.push_back(around);
		return node;
	}

	/// The node at a place, or -1.
	int find(const Place& at) const
	{
		for (size_t slot = hash(at);; slot = (slot + 1) & (table.size() - 1)) {
			const int node = table[slot];
			if (node < 0 || places[size_t(node)] == at)
				return node;
		}
	}

	/**
	 * Adds all nodes of the tetrahedra around the edge from a node to its neighbour.
	 * Complexity: O(1): six nodes around a diagonal, four around an edge along an axis.
	 */
	void completeAround(int node, int direction)
	{
		const Place p = place(node), s = step(direction);
		if (direction % forward < 3) {
			const int k = direction % forward, u = (k + 1) % 3, v = (k + 2) % 3;
			for (int side = 0; side < 4; ++side) {
				Place c = p;
				c[size_t(k)] += s[size_t(k)] / 2;
				c[size_t(u)] += side & 1 ? 1 : -1;
				c[size_t(v)] += side & 2 ? 1 : -1;
				add(c);
			}
			return;
		}
		const Place c = moved(p, direction);
		for (size_t k = 0; k < 3; ++k) {
			Place along = p, back = c;
			along[k] += 2 * s[k];
			back[k] -= 2 * s[k];
			add(along);
			add(back);
		}
	}

	/// Calls visit({a, b, c, d}) for the tetrahedra around the three forward axis edges of an even
	/// node, for none at an odd one: over all nodes, once for each tetrahedron whose nodes exist.
	/// They are oriented so that (b - a) . (c - a) x (d - a) > 0.
	template <class Visit>
	void forEachTetrahedron(int node, const Visit& visit) const
	{
		if (place(node)[0] % 2 != 0)
			return;
		for (int k = 0; k < 3; ++k) {
			const int end = neighbour(node, k);
			if (end < 0)
				continue;
			std::array<int, 4> ring;
			for (int i = 0; i < 4; ++i)
				ring[size_t(i)] = neighbour(node, diagonal(k, i));
			for (size_t i = 0; i < 4; ++i)
				if (ring[i] >= 0 && ring[(i + 1) % 4] >= 0)
					visit(std::array<int, 4> {node, end, ring[i], ring[(i + 1) % 4]});
		}
	}

private:
	Point3d origin;
	double half;
	std::vector<Place> places;
	std::vector<std::array<int, directions>> neighbours;
	std::vector<int> table; ///< open addressing; its size is a power of two

	size_t hash(const Place& at) const
	{
		std::uint64_t h = 0;
		for (int x : at) {
			h = (h ^ std::uint32_t(x)) * 0x9E3779B97F4A7C15u;
			h ^= h >> 29;
		}
		return size_t(h) & (table.size() - 1);
	}

	void enter(int node)
	{
		size_t slot = hash(places[size_t(node)]);
		while (table[slot] >= 0)
			slot = (slot + 1) & (table.size() - 1);
		table[slot] = node;
	}

	void grow()
	{
		table.assign(2 * table.size(), -1);
		for (int node = 0; node < size(); ++node)
			enter(node);
	}

	/// The direction to the i-th of the four nodes around an edge along axis k, counter-clockwise.
	static int diagonal(int k, int i)
	{
		Place s;
		s[size_t(k)] = 1;
		s[size_t((k + 1) % 3)] = i == 0 || i == 3 ? 1 : -1;
		s[size_t((k + 2) % 3)] = i < 2 ? 1 : -1;
		const int sign = s[2];
		return 3 + (s[0] * sign > 0 ? 1 : 0) + (s[1] * sign > 0 ? 2 : 0) + (sign < 0 ? forward : 0);
	}
};

} // namespace vcg::tri::mcf

#endif
