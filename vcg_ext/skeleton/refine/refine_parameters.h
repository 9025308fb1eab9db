// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Refinement, the parameters.

#ifndef VCG_MCF_REFINE_PARAMETERS_H
#define VCG_MCF_REFINE_PARAMETERS_H

#include <skeleton/core/errors.h>
#include <skeleton/core/parameters.h>

#include <cmath>

namespace vcg::tri::mcf {

/**
 * The parameters of refine(). Lengths are fractions of the diagonal of a connected component of the
 * surface: that of its bounding box along its principal axes, see PrincipalFrame.
 */
struct RefineParameters
{
	/// Distance of neighbouring nodes; fraction of the diagonal, in (0, 0.1].
	double spacing = 0.005;
	/// A terminal branch whose end ball sticks out of the ball at its junction by less than this
	/// part of the latter's radius is a spur and is removed; in [0, 1]. If it is above 0, so are
	/// twin tips, forked ends and stubs, see withoutTwinTips(), withoutForkedEnds(), withoutStubs()
	/// and withoutStubsInPlates().
	double spurProminence = 0.1;
	/// Two junctions are one where the smaller ball sticks out of the larger one by less than this
	/// part of its own radius; in [0, 1].
	double junctionProminence = 0.5;
	/// kappa, weight of the smoothness along the branch against that of the centring, for a spacing
	/// of 0.5 % where the shape's radius is 3.3 %; >= 0. Larger: smoother, less centred.
	double smoothing = 20;
	/// Rounds of centring with ten times that smoothness, which free curves that are caught on a
	/// wrong sheet of the medial axis, then rounds with it before and after the last extension of
	/// the tips; >= 0.
	int stiffRounds = 6, rounds = 3, lastRounds = 4;
	/// Minimum distinctness() of a terminal branch, and of what may be its end; in [0, 1], 0: any.
	/// The corners of a box have 0.42, pointed ends with an opening angle of 60 degrees 0.5.
	double tipDistinctness = 0.45;
	/// A tip is extended while the balls reach farther by at least this part of the way, and taken
	/// back where they do not; in (0, 1].
	double tipGain = 0.2;
	/// Minimum radius of an extended tip, see TipRule; fraction of the diagonal, > 0.
	double tipRadius = 0.003;
	/// A part of the surface that is higher above the balls than this part of the radius of the
	/// nearest one, and like a limb, gets a branch: see growFeatures(); >= 0.
	double featureHeight = 0.27;
	/// On the way into such a feature the balls reach farther by at least this part of the way; in
	/// (0, 1]. The corners of boxes have 0.42 to 0.56, limbs of even thickness 1.
	double featureGain = 0.56;
	/// Lengths follow the local thickness where that is small, see LocalScale.
	bool adaptive = true;
	/// @see Parameters::relativeLength
	double relativeLength = 0.6;
	/// @see Parameters::detail
	double detail = Parameters::defaultDetail;

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		// Below that, a curve would exceed CurveBounds::holdAtEnd().
		requireParameter(
			spacing >= 5e-4 && spacing <= 0.1, "spacing", "between 0.05 and 10 % of the diagonal");
		requireParameter(
			spurProminence >= 0 && spurProminence <= 1, "spur_prominence", "between 0 and 1");
		requireParameter(junctionProminence >= 0 && junctionProminence <= 1, "junction_prominence",
			"between 0 and 1");
		requireParameter(smoothing >= 0 && std::isfinite(smoothing), "smoothing", "at least 0");
		requireParameter(
			stiffRounds >= 0 && rounds >= 0 && lastRounds >= 0, "rounds", "at least 0");
		requireParameter(
			tipDistinctness >= 0 && tipDistinctness <= 1, "tip_distinctness", "between 0 and 1");
		requireParameter(tipGain > 0 && tipGain <= 1, "tip_gain", "in (0, 1]");
		requireParameter(
			featureHeight >= 0 && std::isfinite(featureHeight), "feature_height", "at least 0");
		requireParameter(featureGain > 0 && featureGain <= 1, "feature_gain", "in (0, 1]");
		requireParameter(
			relativeLength > 0 && relativeLength <= 2, "relative_length", "between 0 and 2");
		requireParameter(detail >= 0 && detail <= 1, "detail", "between 0 and 1");
		requireParameter(tipRadius > 0 && std::isfinite(tipRadius), "tip_radius", "greater than 0");
	}
};

} // namespace vcg::tri::mcf

#endif
