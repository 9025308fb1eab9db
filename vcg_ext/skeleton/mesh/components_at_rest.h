// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Components that are not worth a flow, or too thin for it: they become curves directly.

#ifndef VCG_MCF_COMPONENTS_AT_REST_H
#define VCG_MCF_COMPONENTS_AT_REST_H

#include "measured_surface.h"
#include "volume_and_area.h"

#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/// With more components than maxWithoutSpecks, those whose diagonal is below speckSize of the
/// largest one's are specks. With fewer, each has its share of vertices: defaultTargetLength().
constexpr int maxWithoutSpecks = 15;
constexpr double speckSize = 0.01;

/**
 * A component is thin where its volume over its area is below this part of its unit of length (see
 * PrincipalFrame): half of a plate's thickness, half of a wire's radius. That is eight steps of the
 * grid on which the resampling and the flow place vertices; anything thinner has no shape on it.
 */
constexpr double thinnest = 8.0 / (1 << 22);

/**
 * The components that rest: specks and thin ones. They are neither resampled nor contracted, but
 * collapsed to curves directly, which costs no more than their own size and keeps their topology.
 * @return 1 for each component that rests. @throws Cancelled. Complexity: O(V + F).
 */
inline std::vector<char> componentsAtRest(
	const MeasuredSurface& surface, const Progress& progress = Progress())
{
	const std::vector<detail::VolumeAndArea> measured = detail::measuredAlongLength(
		surface.mesh(), surface.component(), surface.components(), progress);
	double largest = 0;
	if (surface.components() > maxWithoutSpecks)
		for (int c = 0; c < surface.components(); ++c)
			largest = std::max(largest, surface.diagonal(c));
	std::vector<char> rests;
	for (int c = 0; c < surface.components(); ++c)
		rests.push_back(surface.diagonal(c) < speckSize * largest
			|| measured[c].volume < thinnest * surface.frame(c).unitLength() * measured[c].area);
	return rests;
}

/**
 * Many components share the work: beyond 50 of them, specks not counted, the default epsilon grows
 * with the square root of their number, so that the total work grows no faster than that. An
 * epsilon that the user chose stays, and so does the paper's. Each stage of the pipeline applies
 * it; it is idempotent.
 * @param diagonal of each component. Complexity: O(components).
 */
inline Parameters sharedAmong(Parameters parameters, const std::vector<double>& diagonal)
{
	constexpr double fewComponents = 50, rounding = 1e-6;
	const double usual = Parameters().epsilon;
	if (std::abs(parameters.epsilon - usual) > rounding * usual || !parameters.tidyCurve
		|| diagonal.size() <= fewComponents)
		return parameters;
	const double speck = speckSize * *std::max_element(diagonal.begin(), diagonal.end());
	const auto components =
		std::count_if(diagonal.begin(), diagonal.end(), [&](double own) { return own >= speck; });
	parameters.epsilon *= std::max(1.0, std::sqrt(double(components) / fewComponents));
	parameters.epsilon = std::min(parameters.epsilon, Parameters::maxEpsilon);
	return parameters;
}

} // namespace vcg::tri::mcf

#endif
