// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Who has merged into whom: the correspondence through collapses (Sec. 4.3).

#ifndef VCG_MCF_DISJOINT_SETS_H
#define VCG_MCF_DISJOINT_SETS_H

#include <vector>

namespace vcg::tri::mcf {

/// Disjoint sets of vertices, each with the vertex that stands for it.
class MergeForest
{
public:
	explicit MergeForest(int size) : parent(size)
	{
		for (int v = 0; v < size; ++v)
			parent[v] = v;
	}

	/// Adds a vertex that stands for itself.
	int add()
	{
		parent.push_back(int(parent.size()));
		return parent.back();
	}

	/// From now on `to` stands for all that `from` stood for. @pre both stand for themselves.
	void merge(int from, int to) { parent[from] = to; }

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
