// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Noise estimation, and denoising by Taubin smoothing.

#ifndef VCG_MCF_DENOISE_H
#define VCG_MCF_DENOISE_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/mesh/measured_surface.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

constexpr const char* measuringNoise = "Measuring the noise";

/// The means over the rings of a surface.
class RingMeans
{
public:
	/// @pre mesh is compact. @param what text for progress reports. @throws Cancelled
	RingMeans(const SurfaceMesh& mesh, const Progress& progress, const char* what) :
			mesh(mesh), what(what), valences(filledArray(size_t(mesh.vertexSlots()), 0, progress))
	{
		reportedLoop(
			mesh.halfEdgeSlots(), progress, what, [&](int h) { ++valences[mesh.origin(h)]; });
	}

	int valence(int v) const { return valences[v]; }

	/// For each vertex the mean of `values` over its ring, (M x)_i = sum_j x_j / valence(i).
	/// @throws Cancelled
	std::vector<Point3d> of(const std::vector<Point3d>& values, const Progress& progress) const
	{
		// Face by face: these are adjacent in memory, the faces of a ring are not.
		std::vector<Point3d> mean = filledArray(values.size(), Point3d(0, 0, 0), progress);
		reportedLoop(mesh.faceSlots(), progress.part(0, 0.8), what, [&](int f) {
			const auto [a, b, c] = mesh.triangle(f);
			mean[a] += values[b];
			mean[b] += values[c];
			mean[c] += values[a];
		});
		reportedLoop(int(mean.size()), progress.part(0.8, 1), what,
			[&](int v) { mean[v] /= double(valences[v]); });
		return mean;
	}

private:
	const SurfaceMesh& mesh;
	const char* what;
	std::vector<int> valences;
};

/// Rows of (I - M)^2, one after the other.
class BilaplacianRows
{
public:
	/// @throws Cancelled
	BilaplacianRows(const SurfaceMesh& mesh, const RingMeans& rings, const Progress& progress) :
			mesh(mesh), rings(rings), entry(filledArray(size_t(mesh.vertexSlots()), 0.0, progress))
	{
	}

	/// Number of terms of the row of a vertex: for v, its ring, and the rings of its ring.
	double terms(int v) const
	{
		double count = 1;
		mesh.forEachOutgoing(v, [&](int h) { count += 1 + rings.valence(mesh.target(h)); });
		return count;
	}

	/// Euclidean norm of the row of a vertex. Complexity: O(terms(v)).
	double norm(int v)
	{
		add(v, 1);
		mesh.forEachOutgoing(v, [&](int h) {
			const int j = mesh.target(h);
			add(j, -2.0 / rings.valence(v));
			const double share = 1.0 / (double(rings.valence(v)) * rings.valence(j));
			mesh.forEachOutgoing(j, [&](int g) { add(mesh.target(g), share); });
		});
		double squared = 0;
		for (int column : columns) {
			squared += entry[column] * entry[column];
			entry[column] = 0; // the column may occur again
		}
		columns.clear();
		return std::sqrt(squared);
	}

private:
	const SurfaceMesh& mesh;
	const RingMeans& rings;
	std::vector<double> entry; ///< the current row, by columns
	std::vector<int> columns;  ///< of its entries, some of them more than once

	void add(int column, double value)
	{
		entry[column] += value;
		columns.push_back(column);
	}
};

} // namespace detail

/// How much the vertices of a component deviate from their neighbourhoods.
struct NoiseLevel
{
	/// Standard deviation along the normal if it is noise, mesh units.
	double deviation = 0;
	/// About 1 if the deviation is noise, less if it is facets: see NoiseMeasure.
	double whiteness = 0;
	/// The deviation as a fraction of the local thickness, where that is given.
	double relative = 0;
};

namespace detail {

/// The quantile of the values, which are reordered. @pre values is not empty; part is in [0, 1).
inline double quantile(std::vector<double>& values, double part)
{
	const auto at = values.begin() + std::ptrdiff_t(part * double(values.size()));
	std::nth_element(values.begin(), at, values.end());
	return *at;
}

/// Correlation of the values of neighbours, pairs with an outlier left out.
class NeighbourCorrelation
{
public:
	/// @param maximum values above this, by magnitude, are outliers.
	explicit NeighbourCorrelation(double maximum) : maximum(maximum) {}

	void add(double a, double b)
	{
		if (std::max(std::abs(a), std::abs(b)) > maximum)
			return;
		products += a * b;
		squares += (a * a + b * b) / 2;
	}
	/// As a fraction of the correlation that (I - M)^2 gives to uncorrelated noise: -0.306 on a
	/// mesh of valences six, -0.21 without the outliers.
	double ofWhite() const
	{
		constexpr double white = -0.21;
		return squares > 0 ? products / squares / white : 0;
	}

private:
	double maximum, products = 0, squares = 0;
};

/// The mean of lengths that are given one by one.
class MeanEdge
{
public:
	void add(double length)
	{
		sum += length;
		++count;
	}
	/// 0 if there is none.
	double mean() const { return count > 0 ? sum / count : 0; }

private:
	double sum = 0;
	int count = 0;
};

} // namespace detail

/**
 * The noise of each component.
 *
 * A smooth surface is nearly linear over two rings, so that (I - M)^2 v, M the ring mean, is noise:
 * sigma = 1.4826 median_i |((I - M)^2 v)_i . n_i| / |row i of (I - M)^2|, the median being robust
 * to features, n the vertex normal averaged three times over rings.
 *
 * A clean but coarse surface shows its curvature instead. Two properties tell noise from that: it
 * is independent at each vertex, so that the deviations of neighbours have the correlation that
 * (I - M)^2 gives them, while facets have less; and it is the same everywhere, while facets are
 * large at creases and small within flat parts, so that their distribution has heavier tails than a
 * normal one. The whiteness is the correlation, as a fraction of that of noise, divided by the
 * square root of the ratio of tails.
 */
class NoiseMeasure
{
public:
	/// @param surface kept by reference. @pre its mesh is compact.
	/// @throws Cancelled. Complexity: O(V).
	explicit NoiseMeasure(const MeasuredSurface& surface, const Progress& progress = Progress()) :
			surface(surface), mesh(surface.mesh()),
			rings(mesh, progress.part(0, 0.2), detail::measuringNoise),
			normal(mesh.vertexNormals(progress.part(0.2, 0.3))),
			offset(detail::copiedArray(mesh.position, progress))
	{
		constexpr int normalRounds = 3;
		for (int round = 0; round < normalRounds; ++round)
			normal = rings.of(normal, progress.part(0.3 + 0.1 * round, 0.4 + 0.1 * round));
		// For all vertices: the correlation needs the neighbours of the sampled ones, too.
		for (int power = 0; power < 2; ++power) {
			const Progress part = progress.part(0.6 + 0.2 * power, 0.8 + 0.2 * power);
			const std::vector<Point3d> mean = rings.of(offset, part.part(0, 0.8));
			detail::reportedLoop(mesh.vertexSlots(), part.part(0.8, 1), detail::measuringNoise,
				[&](int v) { offset[v] -= mean[v]; });
		}
	}

	/**
	 * The noise of each component, or of some of its vertices. Of a component, at most 12000
	 * vertices are sampled, spread evenly over its numbering; those with more than some 1000 within
	 * two rings are left out: next to a hub of that many triangles, noise is no property of the
	 * surface.
	 * @param isAsked   of each vertex, 0 to leave it out; empty: none is left out.
	 * @param thickness of each vertex, mesh units; empty: NoiseLevel::relative is not measured.
	 * @throws Cancelled. Complexity: O(V).
	 */
	std::vector<NoiseLevel> levels(const Progress& progress = Progress(),
		const std::vector<char>& isAsked = {}, const std::vector<double>& thickness = {}) const
	{
		constexpr int enough = 12000, maxTerms = 1000;
		detail::BilaplacianRows rows(mesh, rings, progress.cancelOnly());
		const int components = surface.components();
		std::vector<int> size(components, 0), seen(components, 0);
		for (int c : surface.component())
			++size[c];
		std::vector<std::vector<double>> deviations(components);
		std::vector<std::vector<int>> asked(components);
		detail::reportedLoop(mesh.vertexSlots(), progress, detail::measuringNoise, [&](int v) {
			const int c = surface.component()[v];
			if (seen[c]++ % (1 + size[c] / enough) != 0 || (!isAsked.empty() && !isAsked[v]))
				return;
			if (!(normal[v].Norm() > 0) || rows.terms(v) > maxTerms)
				return;
			deviations[c].push_back(std::abs(alongNormal(v)) / rows.norm(v));
			asked[c].push_back(v);
		});
		// Quantiles 25 %, 50 % and 90 % of the magnitude of a normal variable, standard deviations.
		constexpr double quarter = 0.31864, half = 1 / 1.4826, ninth = 1.64485;
		constexpr double outlier = 2.5; // medians
		std::vector<NoiseLevel> level(components);
		for (int c = 0; c < components; ++c) {
			std::vector<double>& d = deviations[c];
			if (d.empty())
				continue;
			if (!thickness.empty()) {
				std::vector<double> relative;
				for (size_t i = 0; i < d.size(); ++i)
					relative.push_back(d[i] / thickness[asked[c][i]]);
				level[c].relative = detail::quantile(relative, 0.5) / half;
			}
			level[c].deviation = detail::quantile(d, 0.5) / half;
			const double tails = detail::quantile(d, 0.9) / ninth,
						 core = detail::quantile(d, 0.25) / quarter;
			if (!(core > 0))
				continue; // flat, with creases
			std::vector<double> offsets;
			for (int v : asked[c])
				offsets.push_back(std::abs(alongNormal(v)));
			detail::NeighbourCorrelation correlation(outlier * detail::quantile(offsets, 0.5));
			for (int v : asked[c])
				mesh.forEachOutgoing(v,
					[&](int h) { correlation.add(alongNormal(v), alongNormal(mesh.target(h))); });
			level[c].whiteness = correlation.ofWhite() / std::sqrt(std::max(tails / core, 1.0));
		}
		return level;
	}

private:
	const MeasuredSurface& surface;
	const SurfaceMesh& mesh;
	detail::RingMeans rings;
	std::vector<Point3d> normal, offset; ///< of each vertex; the latter is (I - M)^2 v

	double alongNormal(int v) const
	{
		const double length = normal[v].Norm();
		return length > 0 ? offset[v] * normal[v] / length : 0;
	}
};

/**
 * A copy of the surface with its noise smoothed away and its volume kept: rounds of Taubin's
 * filter, v <- v + lambda (M v - v), then the same with mu < -lambda (Taubin 1995; lambda 0.5,
 * pass band 0.1).
 * @param rounds for each vertex slot; 0 leaves it where it is.
 * @pre mesh is compact.
 * @throws Cancelled. Complexity: O(V) a round.
 */
inline SurfaceMesh smoothed(const MeasuredSurface& surface, const std::vector<int>& rounds,
	const Progress& progress = Progress())
{
	constexpr double lambda = 0.5, passBand = 0.1;
	constexpr double mu = 1 / (passBand - 1 / lambda);
	const char* const what = "Smoothing noise";
	SurfaceMesh mesh = surface.mesh().copied(progress);
	const int maximum = rounds.empty() ? 0 : *std::max_element(rounds.begin(), rounds.end());
	const detail::RingMeans rings(mesh, progress.cancelOnly(), what);
	for (int half = 0; half < 2 * maximum; ++half) {
		const Progress ofHalf = progress.part(half / (2.0 * maximum), (half + 1) / (2.0 * maximum));
		const std::vector<Point3d> mean = rings.of(mesh.position, ofHalf.part(0, 0.8));
		const double factor = half % 2 == 0 ? lambda : mu;
		detail::reportedLoop(mesh.vertexSlots(), ofHalf.part(0.8, 1), what, [&](int v) {
			if (half / 2 < rounds[v])
				mesh.position[v] += (mean[v] - mesh.position[v]) * factor;
		});
	}
	return mesh;
}

/// The noise of a surface, and the smoothing that it needs.
struct NoiseReport
{
	/// Largest NoiseLevel::deviation of what gets rounds, of a component or of its thin parts,
	/// fraction of its diagonal. If nothing gets any: of all components, facets included.
	double level = 0;
	/// Largest NoiseLevel::relative of the thin parts of a component, likewise; 0 if nothing is
	/// thin.
	double ofThickness = 0;
	/// Rounds of smoothed() for each component, where it is not thin and where it is thin.
	std::vector<int> rounds, roundsWhereThin;

	int maxRounds() const { return *std::max_element(rounds.begin(), rounds.end()); }
	int maxRoundsWhereThin() const
	{
		return *std::max_element(roundsWhereThin.begin(), roundsWhereThin.end());
	}
	bool isNoisy() const { return maxRounds() > 0 || maxRoundsWhereThin() > 0; }

	/// Rounds of each vertex. @param thickness as in measureNoise().
	std::vector<int> ofVertices(
		const std::vector<int>& component, const std::vector<double>& thickness) const
	{
		std::vector<int> ofVertex;
		ofVertex.reserve(component.size());
		for (size_t v = 0; v < component.size(); ++v) {
			const bool isThin = !thickness.empty() && std::isfinite(thickness[v]);
			ofVertex.push_back((isThin ? roundsWhereThin : rounds)[component[v]]);
		}
		return ofVertex;
	}
};

/**
 * Measures the noise and chooses the smoothing: none below 0.03 % of the diagonal or 5 % of the
 * mean edge (clean surfaces show up to 0.04 % or 4 %), 10 rounds up to 0.15 %, 40 above. So
 * treated, models with 0.1 to 0.5 % of noise give the clean model's branches. Nothing is done where
 * the mean edge is longer than 3 % of the diagonal, since noise cannot be told from shape there,
 * thin or not, nor in the thin parts or in the others if their own edges are that long; nor where
 * the whiteness, see NoiseMeasure, is below 0.6: clean surfaces whose facets deviate that much have
 * up to 0.5, those with noise of 0.5 % of the diagonal 0.72 to 1.
 *
 * Thin parts are left out of that and judged by themselves, since neither their facets nor the
 * effect of noise on them depends on the diagonal: no rounds below 5 % of the local thickness
 * (clean trees show up to 2.5 %, with a whiteness of at most 0.1), then 10, 40 above 15 %, and none
 * above 100 %: noise as large as a tube is thick would leave no surface, so that deviations that
 * large are the bends of a coarse tube.
 * @param thickness local thickness of each vertex, mesh units, infinite where the shape is not
 *                  thin; empty: nothing is thin.
 * @pre mesh is compact. @throws Cancelled. Complexity: O(V).
 */
inline NoiseReport measureNoise(const MeasuredSurface& surface,
	const Progress& progress = Progress(), const std::vector<double>& thickness = {})
{
	constexpr double minimum = 3e-4, minOfEdge = 0.05, strong = 1.5e-3;
	constexpr double minOfThickness = 0.05, strongOfThickness = 0.15, maxOfThickness = 1;
	constexpr double coarsestEdge = 0.03, minWhiteness = 0.6;
	constexpr int fewRounds = 10, manyRounds = 40;
	const SurfaceMesh& mesh = surface.mesh();
	std::vector<char> isThin, isThick;
	for (double own : thickness) {
		isThin.push_back(std::isfinite(own));
		isThick.push_back(!std::isfinite(own));
	}
	const NoiseMeasure noise(surface, progress.part(0, 0.7));
	const std::vector<NoiseLevel> all = noise.levels(progress.part(0.7, 0.8));
	std::vector<NoiseLevel> whereThick = all, whereThin(all.size());
	if (!thickness.empty()) {
		whereThick = noise.levels(progress.part(0.8, 0.85), isThick);
		whereThin = noise.levels(progress.part(0.85, 0.9), isThin, thickness);
	}
	const int components = surface.components();
	std::vector<detail::MeanEdge> edges(components), thinEdges(components), thickEdges(components);
	detail::reportedLoop(
		mesh.halfEdgeSlots(), progress.part(0.9, 1), detail::measuringNoise, [&](int h) {
			if (!mesh.isEdge(h))
				return;
			const double length = std::sqrt(mesh.squaredLength(h));
			const int c = surface.component()[mesh.origin(h)];
			edges[c].add(length);
			for (int v : {mesh.origin(h), mesh.target(h)})
				(!isThin.empty() && isThin[v] ? thinEdges : thickEdges)[c].add(length);
		});
	NoiseReport report;
	double ofNoise = 0, ofThinNoise = 0; // the largest deviations of what gets rounds
	double ofAll = 0, ofAllThin = 0;     // and of everything
	for (int c = 0; c < components; ++c) {
		const double edge = edges[c].mean() / surface.diagonal(c);
		const auto isClean = [&](const NoiseLevel& own) {
			const double level = own.deviation / surface.diagonal(c);
			return level < minimum || level < minOfEdge * edge || own.whiteness < minWhiteness;
		};
		const auto isCoarse = [&](const detail::MeanEdge& own) {
			return std::max(own.mean(), edges[c].mean()) > coarsestEdge * surface.diagonal(c);
		};
		const bool isFacets = isCoarse(thickEdges[c]);
		const double level = isFacets ? 0 : whereThick[c].deviation / surface.diagonal(c);
		// Both must be noisy: where most is thin, the rest is a few vertices of its thickest part.
		const bool clean = isFacets || isClean(all[c]) || isClean(whereThick[c]);
		const bool isShape = isCoarse(thinEdges[c]) || whereThin[c].relative > maxOfThickness;
		const double relative = isShape ? 0 : whereThin[c].relative;
		const bool cleanWhereThin =
			relative < minOfThickness || whereThin[c].whiteness < minWhiteness;
		const double levelWhereThin = isShape ? 0 : whereThin[c].deviation / surface.diagonal(c);
		ofAll = std::max({ofAll, level, levelWhereThin});
		ofAllThin = std::max(ofAllThin, relative);
		if (!clean)
			ofNoise = std::max(ofNoise, level);
		if (!cleanWhereThin) {
			ofNoise = std::max(ofNoise, levelWhereThin);
			ofThinNoise = std::max(ofThinNoise, relative);
		}
		report.rounds.push_back(clean ? 0 : level < strong ? fewRounds : manyRounds);
		report.roundsWhereThin.push_back(cleanWhereThin ? 0
				: relative < strongOfThickness          ? fewRounds
														: manyRounds);
	}
	report.level = ofNoise > 0 ? ofNoise : ofAll;
	report.ofThickness = ofThinNoise > 0 ? ofThinNoise : ofAllThin;
	return report;
}

} // namespace vcg::tri::mcf

#endif
