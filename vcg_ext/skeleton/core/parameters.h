// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief All parameters of the pipeline: default, range, unit and equation.

#ifndef VCG_MCF_PARAMETERS_H
#define VCG_MCF_PARAMETERS_H

#include "errors.h"
#include "has_qhull.h"

namespace vcg::tri::mcf {

/// Where the medial poles of the surface come from (Sec. 4.5).
enum class PoleMethod {
	Voronoi, ///< the Voronoi diagram of the vertices, as in the paper; needs Qhull: see has_qhull.h
	Balls    ///< shrinking balls (Ma, Bae, Choi 2012): nearly the same poles, faster, never outside
};

/// What is done with a mesh that does not bound a solid: see make_solid.h.
enum class Repair {
	Auto, ///< small defects are mended; where that is not enough, the surface is wrapped
	Mend, ///< small defects are mended, no more
	Off   ///< it is refused, except for what checkedSurface() repairs
};

/// A set of values for the parameters of the method, not of the shape: see Parameters::apply().
enum class Preset {
	Default, ///< what gives the best skeletons
	Paper    ///< the paper's algorithm and nothing else
};

/**
 * What the user may choose. Lengths are fractions of the bounding box diagonal of a connected
 * component, so that each component of a scene is treated as it would be alone. The box is aligned
 * with the principal axes, see PrincipalFrame; for targetLength, with the coordinate axes.
 */
struct Parameters
{
	/// Smoothness weight w_L (Eq. 6); in [minWeight, maxWeight]. The weights of the Laplacian are
	/// `cotangentFactor` times the sums of the cotangents.
	double wL = 1;
	/// Velocity weight w_H (Eq. 6), in the paper's units; in [minWeight, maxWeight]. Larger: smaller
	/// steps, more of them.
	double wH = 20;
	/// Medial weight w_M (Eq. 6), in the paper's units; in [0, maxWeight]. 0: plain mean curvature
	/// skeleton.
	double wM = 40;
	/// So that products of squared weights stay far inside single precision.
	static constexpr double minWeight = 1e-6, maxWeight = 1e6;
	/// Shorter edges are collapsed (Sec. 4.3); fraction of the diagonal, in (0, maxEpsilon].
	double epsilon = 0.002;
	static constexpr double maxEpsilon = 0.1;
	/// An edge whose two opposite angles are both wider is split (Sec. 4.3); degrees, in [60, 180).
	double splitAngle = 110;
	/// The flow stops after this many iterations even if it has not converged; >= 0.
	int maxIterations = 500;
	PoleMethod poleMethod = PoleMethod::Balls;
	/// Keep sheets of the medial axis where the shape is flat, instead of curves.
	bool keepSheets = false;
	/// Sheetness (see sheetness.h) above which the shape is a sheet; in [0, 1]. 0: nearly the
	/// medial axis; 1: curves only.
	double sheetThreshold = 0.85;
	/// Resample the surface first (first line of Fig. 4).
	bool resample = true;
	/// Edge length of the resampling, fraction of the diagonal; 0: chosen by defaultTargetLength().
	double targetLength = 0;
	/// Lengths follow the local thickness where that is small, see sizingField(); if false, they
	/// are the same everywhere, as in the paper.
	bool adaptive = true;
	/// With `adaptive`, the longest edge of the resampling in local thicknesses; in (0, 2].
	double relativeLength = 0.6;
	/// Rounds of the resampling; >= 0.
	int resampleIterations = 5;
	/// Measure the noise of the surface and smooth it before the resampling: see denoise.h.
	bool denoise = true;
	/// Refine the curve at the end: see refine.h.
	bool refine = true;
	/// With `refine`, the branches whose significance is at least 1 - detail are kept, see
	/// nestedBranches(); in [0, 1]. 0: the trunk alone; 1: all.
	double detail = defaultDetail;
	static constexpr double defaultDetail = 0.9;
	/// Factor of the sums of the cotangents in the Laplacian, in [minWeight, maxWeight]. The
	/// published weights are for 1.
	double cotangentFactor = 0.5;
	/// Merge edges up to two epsilon before the flow, halve those far too long: see firstStage().
	bool coarsen = true;
	/// Leave out the medial term where the pole lies outwards: there the flow has passed the medial
	/// axis.
	bool dropOutwardPoles = true;
	/// Solve the linear systems by a direct Cholesky factorisation in double precision, instead of
	/// to a hundredth by conjugate gradients in single precision.
	bool directSolver = false;
	/// Straighten the zigzag of the curve that the last collapse leaves, remove its spurs, bring
	/// inside what is outside.
	bool tidyCurve = true;
	/// What is done with a mesh that does not bound a solid.
	Repair repair = Repair::Auto;
	/// Pieces below this fraction of the largest one's volume get no skeleton; in [0, 1). 0: each
	/// gets one.
	double minComponent = 0;
	/// Join the skeletons of all pieces by bridges, see join_pieces.h; not where there are sheets.
	bool join = false;

	/**
	 * Sets the parameters of the method: poleMethod, adaptive, denoise, coarsen, cotangentFactor,
	 * dropOutwardPoles, directSolver, tidyCurve and refine. All others are unchanged.
	 */
	void apply(Preset preset)
	{
		const bool isPaper = preset == Preset::Paper;
		poleMethod = isPaper ? PoleMethod::Voronoi : PoleMethod::Balls;
		cotangentFactor = isPaper ? 1 : 0.5;
		directSolver = isPaper;
		adaptive = denoise = coarsen = dropOutwardPoles = tidyCurve = refine = !isPaper;
	}

	/// @throws InvalidParameter naming the first parameter that is out of its range.
	void check() const
	{
		const auto isWeight = [](double w) { return w >= minWeight && w <= maxWeight; };
		const char* const weights = "between 0.000001 and 1000000"; // minWeight, maxWeight
		requireParameter(isWeight(wL), "w_l", weights);
		requireParameter(isWeight(cotangentFactor), "cotangent_factor", weights);
		requireParameter(isWeight(wH), "w_h", weights);
		requireParameter(wM >= 0 && wM <= maxWeight, "w_m", "between 0 and 1000000");
		requireParameter(
			epsilon > 0 && epsilon <= maxEpsilon, "epsilon", "between 0 and 10 % of the diagonal");
		requireParameter(
			splitAngle >= 60 && splitAngle < 180, "split_angle", "in [60, 180) degrees");
		requireParameter(maxIterations >= 0, "max_iterations", "at least 0");
		requireParameter(
			sheetThreshold >= 0 && sheetThreshold <= 1, "sheet_threshold", "between 0 and 1");
		requireParameter(targetLength >= 0 && targetLength <= 0.5, "target_length",
			"between 0 and 50 % of the diagonal");
		requireParameter(relativeLength > 0 && relativeLength <= 2, "relative_length",
			"greater than 0 and at most 2");
		requireParameter(detail >= 0 && detail <= 1, "detail", "between 0 and 1");
		requireParameter(
			minComponent >= 0 && minComponent < 1, "min_component", "at least 0 and less than 1");
		requireParameter(resampleIterations >= 0, "resample_iterations", "at least 0");
		requireParameter(poleMethod != PoleMethod::Voronoi || hasQhull, "pole_method",
			"'balls': this program is built without Qhull, which finds the poles of 'voronoi'");
	}
};

} // namespace vcg::tri::mcf

#endif
