// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Removes fins and folded rims, left by walls that did not meet on the same sites.

#ifndef VCG_MCF_REMOVE_FINS_H
#define VCG_MCF_REMOVE_FINS_H

#include "meso_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// The faces of a skeleton around its edges and nodes.
struct SheetFaces
{
	/// For each edge its faces.
	std::map<EdgeOfComplex, std::vector<int>> around;
	/// How many faces and curve edges each node has.
	std::vector<int> uses;

	explicit SheetFaces(const MesoSkeleton& skeleton) : uses(skeleton.position.size(), 0)
	{
		for (size_t f = 0; f < skeleton.faces.size(); ++f) {
			for (const EdgeOfComplex& e : edgesOf(skeleton.faces[f]))
				around[e].push_back(int(f));
			for (int v : skeleton.faces[f])
				++uses[size_t(v)];
		}
		for (const EdgeOfComplex& e : skeleton.edges)
			for (int v : e)
				++uses[size_t(v)];
	}

	/// The number of faces of an edge: three and more at a seam, one at the rim.
	size_t count(const EdgeOfComplex& e) const { return around.at(e).size(); }
};

/// A part of a sheet between seams and rim.
struct Patch
{
	std::vector<int> faces;
	/// Its edges on seams, and all others.
	std::set<EdgeOfComplex> seam, own;
	bool hasRim = false;
};

/// The patches that have seams, the smallest first.
inline std::vector<Patch> patchesAtSeams(
	const std::vector<FaceOfComplex>& faces, const SheetFaces& sheets)
{
	std::vector<char> seen(faces.size(), 0);
	std::vector<Patch> patches;
	for (size_t seed = 0; seed < faces.size(); ++seed) {
		if (seen[seed])
			continue;
		seen[seed] = 1;
		Patch patch;
		patch.faces.push_back(int(seed));
		for (size_t i = 0; i < patch.faces.size(); ++i)
			for (const EdgeOfComplex& e : edgesOf(faces[size_t(patch.faces[i])])) {
				const std::vector<int>& of = sheets.around.at(e);
				(of.size() > 2 ? patch.seam : patch.own).insert(e);
				patch.hasRim |= of.size() == 1;
				if (of.size() == 2)
					for (int g : of)
						if (!std::exchange(seen[size_t(g)], 1))
							patch.faces.push_back(g);
			}
		if (!patch.seam.empty())
			patches.push_back(std::move(patch));
	}
	std::stable_sort(patches.begin(), patches.end(),
		[](const Patch& a, const Patch& b) { return a.faces.size() < b.faces.size(); });
	return patches;
}

/**
 * Whether a patch is a fin, see removeFins(). If so, the target of each node that no other face or
 * curve edge has becomes the nearest node of the patch's seams.
 */
inline bool isFin(const Patch& patch, const MesoSkeleton& skeleton, const SheetFaces& sheets,
	std::vector<int>& target)
{
	if (!patch.hasRim)
		return false;
	std::map<int, int> uses;
	for (int f : patch.faces)
		for (int v : skeleton.faces[size_t(f)])
			++uses[v];
	std::vector<std::pair<int, int>> ends;
	for (const auto& [v, count] : uses) {
		if (count != sheets.uses[size_t(v)])
			continue;
		if (skeleton.isHeld(v))
			return false;
		int nearest = -1;
		double minimum = std::numeric_limits<double>::max();
		for (const EdgeOfComplex& e : patch.seam)
			for (int w : e) {
				const double distance =
					Distance(skeleton.position[size_t(v)], skeleton.position[size_t(w)]);
				if (distance < minimum) {
					minimum = distance;
					nearest = w;
				}
			}
		if (!(minimum < skeleton.radius[size_t(nearest)]))
			return false;
		ends.emplace_back(v, nearest);
	}
	if (ends.size() + patch.faces.size() != patch.own.size())
		return false;
	for (const auto& [v, end] : ends)
		target[size_t(v)] = end;
	return true;
}

/// Removes the faces that are marked.
inline void removeFaces(MesoSkeleton& skeleton, const std::vector<char>& marked)
{
	std::vector<FaceOfComplex> left;
	for (size_t f = 0; f < skeleton.faces.size(); ++f)
		if (!marked[f])
			left.push_back(skeleton.faces[f]);
	skeleton.faces = std::move(left);
}

} // namespace detail

/**
 * Removes fins: patches between seams and rim that stick out of a seam by less than the thickness
 * there. They are left where two walls did not meet on the same sites. What merged into their nodes
 * goes to the nearest node of their seams. Fins that hold vertices stay.
 *
 * The topology stays: a patch is removed if it has a rim, and V - E + F = 0 for the nodes, edges
 * and faces that it does not share with the rest. Being connected, it then adds nothing to the
 * homology. The smallest go first; patches at the same seam wait for the next round, since it may
 * be no seam any more.
 * @pre radius is set. Complexity: O(F log F) for each round: as many as fins lie on fins.
 */
inline void removeFins(MesoSkeleton& skeleton)
{
	for (bool found = true; found;) {
		found = false;
		const detail::SheetFaces sheets(skeleton);
		std::vector<int> target(skeleton.position.size());
		std::iota(target.begin(), target.end(), 0);
		std::vector<char> removed(skeleton.faces.size(), 0);
		std::set<EdgeOfComplex> changed;
		for (const detail::Patch& patch : detail::patchesAtSeams(skeleton.faces, sheets)) {
			const bool waits = std::any_of(patch.seam.begin(), patch.seam.end(),
				[&](const EdgeOfComplex& e) { return changed.count(e) > 0; });
			if (waits || !detail::isFin(patch, skeleton, sheets, target))
				continue;
			found = true;
			changed.insert(patch.seam.begin(), patch.seam.end());
			for (int f : patch.faces)
				removed[size_t(f)] = 1;
		}
		detail::removeFaces(skeleton, removed);
		removeMergedNodes(skeleton, target);
	}
}

/**
 * Opens folded rims: where two walls did not meet on the same sites, the rim may lie on the sheet
 * along an edge. Of such a seam, a single edge of three faces, the smallest face that has another
 * edge on the rim is removed. A sheet that really meets others does so along many edges. The
 * topology and all nodes stay: of two such faces that share an edge one is left.
 * Complexity: O(F log F).
 */
inline void openFolds(MesoSkeleton& skeleton)
{
	const detail::SheetFaces sheets(skeleton);
	std::vector<int> seamsAt(skeleton.position.size(), 0);
	for (const auto& [e, faces] : sheets.around)
		for (int v : e)
			seamsAt[size_t(v)] += faces.size() > 2;
	std::vector<char> removed(skeleton.faces.size(), 0);
	const auto besideRemoved = [&](const FaceOfComplex& face) {
		for (const EdgeOfComplex& side : edgesOf(face))
			for (int f : sheets.around.at(side))
				if (removed[size_t(f)])
					return true;
		return false;
	};
	for (const auto& [e, faces] : sheets.around) {
		if (faces.size() != 3 || seamsAt[size_t(e[0])] > 1 || seamsAt[size_t(e[1])] > 1)
			continue;
		int smallest = -1;
		double minimum = std::numeric_limits<double>::max();
		for (int f : faces) {
			const FaceOfComplex& face = skeleton.faces[size_t(f)];
			std::multiset<size_t> counts;
			for (const EdgeOfComplex& side : edgesOf(face))
				counts.insert(sheets.count(side));
			const double area = faceArea(skeleton.position, face);
			if (counts == std::multiset<size_t> {1, 2, 3} && area < minimum
				&& !besideRemoved(face)) {
				minimum = area;
				smallest = f;
			}
		}
		if (smallest >= 0)
			removed[size_t(smallest)] = 1;
	}
	detail::removeFaces(skeleton, removed);
}

} // namespace vcg::tri::mcf

#endif
