// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Who has merged into whom: the correspondence through collapses (Sec. 4.3).

#ifndef VCG_MCF_DISJOINT_SETS_H
#define VCG_MCF_DISJOINT_SETS_H

#include "large_arrays.h"

#include <algorithm>
#include <vector>

namespace vcg::tri::mcf {

/// Disjoint sets of vertices, each with the vertex that stands for it.
class MergeForest
{
public:
	/// Each vertex stands for itself. @throws Cancelled
	explicit MergeForest(int size, const Cancellation& cancel = Cancellation()) :
			parent(detail::numberedArray(size_t(size), cancel))
	{
	}

	/// Adds a vertex that stands for itself.
	int add()
	{
		parent.push_back(int(parent.size()));
		return parent.back();
	}

	/// From now on `to` stands for all that `from` stood for. @pre both stand for themselves.
	void merge(int from, int to) { parent[from] = to; }

	/// Unites the sets of a and b; the lower of the two that stood for them stands for all.
	/// @return whether they were two sets.
	bool join(int a, int b)
	{
		a = find(a);
		b = find(b);
		parent[std::max(a, b)] = std::min(a, b);
		return a != b;
	}

	int size() const { return int(parent.size()); }

	/// The vertex that stands for v.
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
