// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Noise estimation, and denoising by Taubin smoothing.

#ifndef VCG_MCF_DENOISE_H
#define VCG_MCF_DENOISE_H

#include <skeleton/core/reported_arrays.h>
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
	/// @pre mesh is compact. @param what it is done for. @throws Cancelled
	RingMeans(const SurfaceMesh& mesh, const Progress& progress, const char* what) :
			mesh(mesh), what(what),
			valences(filledArray(size_t(mesh.vertexSlots()), 0, progress, what))
	{
		reportedLoop(
			mesh.halfEdgeSlots(), progress, what, [&](int h) { ++valences[mesh.origin(h)]; });
	}

	int valence(int v) const { return valences[v]; }

	/// For each vertex the mean of `values` over its ring, (M x)_i = sum_j x_j / valence(i).
	/// @throws Cancelled
	std::vector<Point3d> of(const std::vector<Point3d>& values, const Progress& progress) const
	{
		// In the order of the faces, which lie side by side, unlike those of a ring.
		std::vector<Point3d> mean = filledArray(values.size(), Point3d(0, 0, 0), progress, what);
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
			mesh(mesh), rings(rings),
			entry(filledArray(size_t(mesh.vertexSlots()), 0.0, progress, measuringNoise))
	{
	}

	struct Row
	{
		/// ((I - M)^2 x)_v for the positions x, mesh units.
		Point3d ofPositions = Point3d(0, 0, 0);
		/// Euclidean.
		double norm = 0;
	};

	Row at(int v)
	{
		// The row has an entry for v, its ring, and the rings of its ring.
		add(v, 1);
		mesh.forEachOutgoing(v, [&](int h) {
			const int j = mesh.target(h);
			add(j, -2.0 / rings.valence(v));
			const double share = 1.0 / (double(rings.valence(v)) * rings.valence(j));
			mesh.forEachOutgoing(j, [&](int g) { add(mesh.target(g), share); });
		});
		Row row;
		double squared = 0;
		for (int column : columns) {
			// The entries add up to zero: positions count from that of v.
			row.ofPositions += (mesh.position[column] - mesh.position[v]) * entry[column];
			squared += entry[column] * entry[column];
			entry[column] = 0; // the column may come again
		}
		columns.clear();
		row.norm = std::sqrt(squared);
		return row;
	}

private:
	const SurfaceMesh& mesh;
	const RingMeans& rings;
	std::vector<double> entry; ///< of the row at hand, by columns
	std::vector<int> columns;  ///< that it has, some of them more than once

	void add(int column, double value)
	{
		entry[column] += value;
		columns.push_back(column);
	}
};

} // namespace detail

/**
 * Standard deviation of the noise along the normal, for each component, mesh units.
 *
 * What is smooth is nearly linear over two rings, so that (I - M)^2 v, M the ring mean, is noise:
 * sigma = 1.4826 median_i |((I - M)^2 v)_i . n_i| / |row i of (I - M)^2|, the median being blind to
 * features, n the normal averaged three times. A clean but coarse surface shows its curvature
 * instead: compare with the edge length. @pre mesh is compact.
 * @param still 1 for vertices that are not asked, see measureNoise(); may be empty.
 * Of a large component some 12000 vertices are looked at, spread evenly over its numbering.
 * @throws Cancelled. Complexity: O(V).
 */
inline std::vector<double> noiseLevel(const MeasuredSurface& surface,
	const Progress& progress = Progress(), const std::vector<char>& still = {})
{
	constexpr int enough = 12000, normalRounds = 3;
	const SurfaceMesh& mesh = surface.mesh();
	const detail::RingMeans rings(mesh, progress.part(0, 0.1), detail::measuringNoise);
	std::vector<Point3d> normal = mesh.vertexNormals(progress.part(0.1, 0.2));
	for (int round = 0; round < normalRounds; ++round)
		normal = rings.of(normal, progress.part(0.2 + 0.2 * round, 0.4 + 0.2 * round));
	detail::BilaplacianRows rows(mesh, rings, progress.part(0.8, 0.8));
	const int components = surface.components();
	std::vector<int> size(components, 0), seen(components, 0);
	for (int c : surface.component())
		++size[c];
	std::vector<std::vector<double>> deviations(components);
	detail::reportedLoop(
		mesh.vertexSlots(), progress.part(0.8, 1), detail::measuringNoise, [&](int v) {
			const int c = surface.component()[v];
			if (seen[c]++ % (1 + size[c] / enough) != 0 || (!still.empty() && still[v]))
				return;
			const double length = normal[v].Norm();
			if (!(length > 0))
				return;
			const auto row = rows.at(v);
			deviations[c].push_back(std::abs(row.ofPositions * normal[v]) / length / row.norm);
		});
	constexpr double deviationOfMedian = 1.4826; // of a normal distribution
	std::vector<double> sigma(components, 0);
	for (int c = 0; c < components; ++c) {
		std::vector<double>& d = deviations[c];
		if (d.empty())
			continue;
		std::nth_element(d.begin(), d.begin() + d.size() / 2, d.end());
		sigma[c] = deviationOfMedian * d[d.size() / 2];
	}
	return sigma;
}

/**
 * A copy of the surface with its noise smoothed away and its volume kept: rounds of Taubin's
 * filter, v <- v + lambda (M v - v), then the same with mu < -lambda (Taubin 1995; lambda 0.5,
 * pass band 0.1).
 * @param rounds for each component, in the order of connectedComponents(); 0 leaves it alone.
 * @param still  1 for vertices that stay where they are; may be empty.
 * @pre mesh is compact.
 * @throws Cancelled. Complexity: O(V) a round.
 */
inline SurfaceMesh smoothed(const MeasuredSurface& surface, const std::vector<int>& rounds,
	const Progress& progress = Progress(), const std::vector<char>& still = {})
{
	constexpr double lambda = 0.5, passBand = 0.1;
	constexpr double mu = 1 / (passBand - 1 / lambda);
	const char* const what = "Smoothing noise";
	SurfaceMesh mesh = surface.mesh().copied(progress.part(0, 0));
	const int most = rounds.empty() ? 0 : *std::max_element(rounds.begin(), rounds.end());
	const detail::RingMeans rings(mesh, progress.part(0, 0), what);
	for (int half = 0; half < 2 * most; ++half) {
		const Progress ofHalf = progress.part(half / (2.0 * most), (half + 1) / (2.0 * most));
		const std::vector<Point3d> mean = rings.of(mesh.position, ofHalf.part(0, 0.8));
		const double factor = half % 2 == 0 ? lambda : mu;
		detail::reportedLoop(mesh.vertexSlots(), ofHalf.part(0.8, 1), what, [&](int v) {
			if (half / 2 < rounds[surface.component()[v]] && (still.empty() || !still[v]))
				mesh.position[v] += (mean[v] - mesh.position[v]) * factor;
		});
	}
	return mesh;
}

/// What a surface's noise is and what to do about it.
struct NoiseReport
{
	/// Standard deviation of the noisiest component, fraction of its diagonal.
	double level = 0;
	/// Rounds of smoothed() for each component.
	std::vector<int> rounds;

	int mostRounds() const { return *std::max_element(rounds.begin(), rounds.end()); }
	bool isNoisy() const { return mostRounds() > 0; }
};

/**
 * Measures the noise and chooses the smoothing: none below 0.03 % of the diagonal or 5 % of the
 * mean edge (clean surfaces show up to 0.04 % or 4 %), 10 rounds up to 0.15 %, 40 above. So treated,
 * models with 0.1 to 0.5 % of noise give the clean model's branches. Where the mean edge is longer
 * than 3 % of the diagonal, noise cannot be told from shape, and nothing is done.
 * @param still 1 for vertices that are not asked: those of parts so thin that their facets would count
 *              as noise; may be empty.
 * @pre mesh is compact. @throws Cancelled. Complexity: O(V).
 */
inline NoiseReport measureNoise(const MeasuredSurface& surface,
	const Progress& progress = Progress(), const std::vector<char>& still = {})
{
	constexpr double least = 3e-4, leastOfEdge = 0.05, strong = 1.5e-3;
	constexpr double coarsestEdge = 0.03;
	constexpr int fewRounds = 10, manyRounds = 40;
	const SurfaceMesh& mesh = surface.mesh();
	const std::vector<double> sigma = noiseLevel(surface, progress.part(0, 0.9), still);
	const int components = surface.components();
	std::vector<double> edgeSum(components, 0);
	std::vector<int> edgeCount(components, 0);
	detail::reportedLoop(
		mesh.halfEdgeSlots(), progress.part(0.9, 1), detail::measuringNoise, [&](int h) {
			if (!mesh.isEdge(h))
				return;
			const int c = surface.component()[mesh.origin(h)];
			edgeSum[c] += std::sqrt(mesh.squaredLength(h));
			++edgeCount[c];
		});
	NoiseReport report;
	for (int c = 0; c < components; ++c) {
		const double edge = edgeSum[c] / edgeCount[c] / surface.diagonal(c);
		const double level = edge > coarsestEdge ? 0 : sigma[c] / surface.diagonal(c);
		const bool clean = level < least || level < leastOfEdge * edge;
		report.level = std::max(report.level, level);
		report.rounds.push_back(clean ? 0 : level < strong ? fewRounds : manyRounds);
	}
	return report;
}

} // namespace vcg::tri::mcf

#endif
