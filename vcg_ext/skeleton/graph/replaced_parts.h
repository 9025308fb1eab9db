// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A skeleton of which some connected parts are replaced by other curves.

#ifndef VCG_MCF_REPLACED_PARTS_H
#define VCG_MCF_REPLACED_PARTS_H

#include "curve_skeleton.h"

#include <vector>

namespace vcg::tri::mcf {

/// What withReplacedParts() returns.
struct ReplacedParts
{
	CurveSkeleton curve;
	/// For each node of the given skeleton its new number, -1 if it is gone.
	std::vector<int> number;
	/// For each added part the number of its first node; its other nodes follow in their order.
	std::vector<int> first;
};

/**
 * Removes connected parts of a skeleton and adds other curves. Surface vertices of removed nodes
 * get -1; `node` of the added parts and all marks of bridges are left out.
 * @param isGone 1 for the nodes to remove, whole connected parts.
 * @param parts  to add; each has a significance if the skeleton has one.
 * Complexity: O(V + E + surface vertices).
 */
inline ReplacedParts withReplacedParts(const CurveSkeleton& curve, const std::vector<char>& isGone,
	const std::vector<const CurveSkeleton*>& parts)
{
	ReplacedParts result;
	CurveSkeleton& made = result.curve;
	const bool isSignificant = !curve.significance.empty();
	result.number.assign(curve.position.size(), -1);
	const auto add = [&](const CurveSkeleton& from, size_t v) {
		made.position.push_back(from.position[v]);
		made.radius.push_back(from.radius[v]);
		if (isSignificant)
			made.significance.push_back(from.significance[v]);
	};
	for (size_t v = 0; v < isGone.size(); ++v)
		if (!isGone[v]) {
			result.number[v] = int(made.position.size());
			add(curve, v);
		}
	for (const auto& [a, b] : curve.edges)
		if (!isGone[size_t(a)])
			made.edges.push_back({result.number[size_t(a)], result.number[size_t(b)]});
	made.node.reserve(curve.node.size());
	for (int v : curve.node)
		made.node.push_back(v < 0 ? -1 : result.number[size_t(v)]);
	for (const CurveSkeleton* part : parts) {
		const int first = int(made.position.size());
		result.first.push_back(first);
		for (size_t v = 0; v < part->position.size(); ++v)
			add(*part, v);
		for (const auto& [a, b] : part->edges)
			made.edges.push_back({first + a, first + b});
	}
	return result;
}

} // namespace vcg::tri::mcf

#endif
