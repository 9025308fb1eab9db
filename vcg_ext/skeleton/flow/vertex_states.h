// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The state of each vertex in the flow, besides its position.

#ifndef VCG_MCF_VERTEX_STATES_H
#define VCG_MCF_VERTEX_STATES_H

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <vcg/space/point3.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/**
 * The state of all vertices, an array for each property.
 *
 * Whatever renumbers the vertices goes through forEachProperty(), which does not compile if it
 * leaves a property out.
 */
struct VertexStates
{
	/// Medial pole of each vertex, and its distance from the surface; < 0: none, as after a split.
	std::vector<Point3d> pole;
	std::vector<double> poleRadius;
	/// 1 where the vertex does not move: its neighbourhood has collapsed (Sec. 4.4), its sheet has
	/// arrived, it is held, or its component rests.
	std::vector<char> fixed;
	/// 1 where the user holds the vertex, see holdVertices(); such a vertex is fixed, too.
	std::vector<char> held;
	/// 1 where the flow keeps a sheet of the medial axis, see markSheets().
	std::vector<char> sheet;
	/// Connected component of each vertex.
	std::vector<int> component;
	/// Upper bound of epsilon at each vertex, fraction of its component's diagonal; small where the
	/// shape is thin: see epsilonLimits(). Empty: no bound anywhere.
	std::vector<double> epsilonLimit;

	/// Calls visit(array) for each property; for `epsilonLimit` only where it is not empty.
	template <class Visit>
	void forEachProperty(Visit&& visit)
	{
		forEachPropertyOf(*this, visit);
	}
	template <class Visit>
	void forEachProperty(Visit&& visit) const
	{
		forEachPropertyOf(*this, visit);
	}

	/// Whether each property has `count` values.
	bool areOf(size_t count) const
	{
		bool all = true;
		forEachProperty([&](const auto& values) { all &= values.size() == count; });
		return all;
	}

	/// Reorders the vertices. @param newVertex the new index of each, below `count`; < 0: removed.
	/// @throws Cancelled; then the states must be discarded.
	void renumber(
		const std::vector<int>& newVertex, int count, const Cancellation& cancel = Cancellation())
	{
		forEachProperty([&](auto& values) {
			std::decay_t<decltype(values)> moved(static_cast<size_t>(count));
			detail::cancellableLoop(int(values.size()), cancel, [&](int v) {
				if (newVertex[v] >= 0)
					moved[size_t(newVertex[v])] = values[v];
			});
			values = std::move(moved);
		});
	}

	/// The states of the given vertices, in that order.
	VertexStates picked(const std::vector<int>& vertices) const
	{
		VertexStates some = *this;
		some.forEachProperty([&](auto& values) {
			std::decay_t<decltype(values)> kept;
			kept.reserve(vertices.size());
			for (int v : vertices)
				kept.push_back(values[size_t(v)]);
			values = std::move(kept);
		});
		return some;
	}

	/**
	 * Adds a vertex on the edge from a to b, at a + t (b - a), t in [0, 1].
	 *
	 * It has no pole, except within a sheet, where poles vary smoothly: there it has one between
	 * theirs.
	 * @param place of the new vertex. @param isHeld whether the user holds it.
	 */
	void addBetween(int a, int b, double t, const Point3d& place, bool isHeld)
	{
		const bool isSheet = sheet[a] && sheet[b];
		pole.push_back(isSheet ? pole[a] * (1 - t) + pole[b] * t : place);
		poleRadius.push_back(isSheet ? poleRadius[a] * (1 - t) + poleRadius[b] * t : -1);
		sheet.push_back(isSheet);
		fixed.push_back(isHeld);
		held.push_back(isHeld);
		component.push_back(component[a]);
		if (epsilonLimit.empty())
			return;
		// Rounding must not leave the range.
		const double ofA = epsilonLimit[a], ofB = epsilonLimit[b];
		epsilonLimit.push_back(
			std::clamp(ofA * (1 - t) + ofB * t, std::min(ofA, ofB), std::max(ofA, ofB)));
	}

	/// Merges the states of two vertices. @param place of the survivor after the merge.
	void merge(int removed, int survivor, const Point3d& place)
	{
		// Of the two poles the one closest to the resulting vertex stays (Sec. 4.5).
		const bool removedHas = poleRadius[removed] >= 0, survivorHas = poleRadius[survivor] >= 0;
		// A vertex of a sheet keeps its pole, or its rim would wear away.
		const bool takesPole = sheet[removed] != sheet[survivor] ? sheet[removed]
																 : removedHas
				&& (!survivorHas
					|| SquaredDistance(place, pole[removed])
						< SquaredDistance(place, pole[survivor]));
		if (takesPole) {
			pole[survivor] = pole[removed];
			poleRadius[survivor] = poleRadius[removed];
		}
		if (!epsilonLimit.empty())
			epsilonLimit[survivor] = std::min(epsilonLimit[survivor], epsilonLimit[removed]);
		fixed[survivor] |= fixed[removed];
		held[survivor] |= held[removed];
		sheet[survivor] |= sheet[removed];
	}

private:
	template <class States, class Visit>
	static void forEachPropertyOf(States& states, Visit&& visit)
	{
		auto& [pole, poleRadius, fixed, held, sheet, component, epsilonLimit] = states;
		visit(pole);
		visit(poleRadius);
		visit(fixed);
		visit(held);
		visit(sheet);
		visit(component);
		if (!epsilonLimit.empty())
			visit(epsilonLimit);
	}
};

} // namespace vcg::tri::mcf

#endif
