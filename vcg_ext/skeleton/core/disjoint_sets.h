// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Disjoint sets of vertices: which one each has merged into by collapses (Sec. 4.3).

#ifndef VCG_MCF_DISJOINT_SETS_H
#define VCG_MCF_DISJOINT_SETS_H

#include "large_arrays.h"

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/// Disjoint sets of vertices, each with a representative.
class MergeForest
{
public:
	/// Each of the vertices 0 to size - 1 is alone in its set. @throws Cancelled
	explicit MergeForest(int size, const Cancellation& cancel = Cancellation()) :
			parent(detail::numberedArray(size_t(size), cancel))
	{
	}

	/// Adds a vertex, alone in its set. @return the vertex.
	int add()
	{
		parent.push_back(int(parent.size()));
		return parent.back();
	}

	/// Merges the set of `from` into that of `to`. @pre both are representatives; `to` stays one.
	void merge(int from, int to) { parent[from] = to; }

	/// Unites the sets of a and b; the lower of their representatives represents both.
	/// @return whether the sets were different.
	bool join(int a, int b)
	{
		a = find(a);
		b = find(b);
		parent[std::max(a, b)] = std::min(a, b);
		return a != b;
	}

	int size() const { return int(parent.size()); }

	/// The representative of the set of v; halves the path to it.
	int find(int v)
	{
		while (parent[v] != v)
			v = parent[v] = parent[parent[v]];
		return v;
	}

private:
	std::vector<int> parent;
};

} // namespace vcg::tri::mcf

#endif
