// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The linear system of one step of the flow (Eq. 6).

#ifndef VCG_MCF_FLOW_SYSTEM_H
#define VCG_MCF_FLOW_SYSTEM_H

#include "cotangent_weights.h"
#include "fill_reducing_order.h"
#include "stage.h"

#include <skeleton/core/parallel.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/solver/symmetric_csr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vcg::tri::mcf {

/**
 * Factor of w_H and w_M: the paper's (w_L, w_H, w_M) = (1, 20, 40) is (1, 0.1, 0.2) for a Laplacian
 * of weights cot(alpha) + cot(beta). The paper's numbers are those of its authors' program with
 * mean value weights, which carry 1 / length; the others are those of their program with
 * cotangents. Relative to the Laplacian both are equal for equilateral triangles with edges of
 * 0.005 units.
 */
constexpr double publishedWeightUnit = 1.0 / 200;

/// The medial weight, squared, of vertices of sheets: strong enough to bring both walls together
/// before the smoothing has pulled the rim in.
constexpr double sheetWeight2 = 4;

/**
 * (M^2 + D) y = b for the moves y of the free vertices: the minimum of Eq. 6, see contract().
 *
 * M is w_L L, with parameters.cotangentFactor, restricted to the free vertices, and D = w_H^2 +
 * w_M^2, or w_H^2 without the medial term. With x = v + y it follows from Eq. 6 that
 *     b = w_M^2 (mu - v) - M (w_L L v),
 * where fixed neighbours count in L v: only differences, so that no digits are lost far from the
 * origin.
 */
struct FlowSystem
{
	/// The vertex of each unknown, in the order of elimination.
	std::vector<int> vertex;
	SymmetricRows M;
	std::vector<float> D;
	std::vector<Point3d> b;

	/// The system of the unknowns in [begin, end). @pre the others do not depend on them.
	FlowSystem part(int begin, int end) const
	{
		const auto cut = [&](const auto& values) {
			return std::vector(values.begin() + begin, values.begin() + end);
		};
		return {cut(vertex), M.part(begin, end), cut(D), cut(b)};
	}
};

/**
 * The system of all components; the unknowns of each are consecutive.
 * @pre stage.mesh is compact.
 * @throws Cancelled. Complexity: O(V + F).
 */
inline FlowSystem flowSystem(
	const Stage& stage, const Parameters& parameters, const Progress& progress = Progress())
{
	const SurfaceMesh& mesh = stage.mesh;
	const double wL = 2 * parameters.cotangentFactor * parameters.wL; // for cotangentWeight()
	const double wH2 = std::pow(parameters.wH * publishedWeightUnit, 2);
	const double wM2 = std::pow(parameters.wM * publishedWeightUnit, 2);

	progress.report(0, "Contracting");
	FlowSystem system;
	system.vertex = eliminationOrder(stage);
	const std::vector<int>& vertexOfUnknown = system.vertex;
	SymmetricRows& M = system.M;
	std::vector<float>& D = system.D;
	std::vector<Point3d>& b = system.b;
	const int n = int(vertexOfUnknown.size());
	std::vector<int> unknown(mesh.vertexSlots(), -1);
	const Progress cancel = progress.cancelOnly();
	detail::cancellableLoop(n, cancel, [&](int i) { unknown[vertexOfUnknown[i]] = i; });
	progress.report(0, "Contracting");
	// Of the triangles with free vertices: the cotangents, the area-weighted normals of the
	// vertices, and the numbers of entries in the rows of M.
	M.excess.resize(n);
	M.diagonal.resize(n);
	M.start.assign(n + 1, 0);
	std::vector<float> cotangent(mesh.halfEdgeSlots());
	std::vector<Point3d> normal(mesh.vertexSlots(), Point3d(0, 0, 0));
	// Rows are assembled triangle by triangle, since a walk around each vertex waits for every
	// step. If they are many, each thread assembles a range of them, and looks for their triangles
	// in the whole mesh.
	constexpr int minForTeam = 1 << 14;
	const std::vector<int> ranges = rangesForThreads(n, minForTeam);
	const auto onAllCores = [&](const Progress& part, const auto& make) {
		if (ranges.size() == 2)
			make([](int row) { return row >= 0; }, part.cancelOnly());
		else
			forEachPart(ranges, part, "Contracting", [&](int begin, int end, const Progress& own) {
				make([begin, end](int row) { return row >= begin && row < end; }, own.cancelOnly());
			});
	};
	const auto forEachTriangle = [&](const auto& isMine, const Progress& own, auto&& visit) {
		detail::cancellableLoop(mesh.faceSlots(), own, [&](int f) {
			const Triangle t = mesh.triangle(f);
			const std::array<int, 3> row = {unknown[t[0]], unknown[t[1]], unknown[t[2]]};
			if (isMine(row[0]) || isMine(row[1]) || isMine(row[2]))
				visit(f, t, row);
		});
	};
	onAllCores(progress.part(0, 0.5), [&](const auto& isMine, const Progress& own) {
		forEachTriangle(isMine, own, [&](int f, const Triangle& t, const std::array<int, 3>& row) {
			const TriangleMeasures measures = measureTriangle(mesh, f);
			if (isMine(std::max({row[0], row[1], row[2]}))) // one of the threads that measure it
				for (int k = 0; k < 3; ++k)
					cotangent[3 * f + k] = float(measures.cotangent[k]);
			for (int k = 0; k < 3; ++k)
				if (isMine(row[k])) {
					normal[t[k]] += measures.doubleAreaVector;
					M.start[row[k] + 1] += row[(k + 1) % 3] >= 0;
				}
		});
	});
	for (int i = 0; i < n; ++i)
		M.start[i + 1] = M.start[i] + filledUp(M.start[i + 1], SymmetricRows::Group);
	progress.report(0.5, "Contracting");

	M.entries.resize(M.start[n]);
	std::vector<int> end(M.start.begin(), M.start.end() - 1);
	std::vector<double> toFree(n, 0), toFixed(n, 0); // sums of the weights of a row
	std::vector<Point3d> curvature(mesh.vertexSlots(), Point3d(0, 0, 0)); // w_L L v
	onAllCores(progress.part(0.5, 1), [&](const auto& isMine, const Progress& own) {
		forEachTriangle(isMine, own, [&](int f, const Triangle& t, const std::array<int, 3>& row) {
			for (int k = 0; k < 3; ++k) {
				const int i = row[k], j = row[(k + 1) % 3], h = 3 * f + k;
				if (!isMine(i))
					continue;
				const int v = t[k], to = t[(k + 1) % 3];
				const double w = wL * cotangentWeight(cotangent[h], cotangent[mesh.twin(h)]);
				(j >= 0 ? toFree : toFixed)[i] += w;
				curvature[v] += (mesh.position[v] - mesh.position[to]) * w;
				if (j >= 0)
					M.entries[end[i]++] = {j, float(-w)};
			}
		});
	});
	D.resize(n);
	b.resize(n);
	FloatQuads Lv(n);
	detail::cancellableLoop(n, cancel, [&](int i) {
		const int v = vertexOfUnknown[i];
		M.excess[i] = float(toFixed[i]);
		M.diagonal[i] = float(toFixed[i] + toFree[i]);
		Lv[i] =
			FloatQuad(float(curvature[v][0]), float(curvature[v][1]), float(curvature[v][2]), 0.f);
		D[i] = float(wH2);
		b[i] = Point3d(0, 0, 0);
		const bool sheet = stage.sheet[v];
		const Point3d toPole = stage.pole[v] - mesh.position[v];
		const bool isAhead = toPole * normal[v] <= 0 || !parameters.dropOutwardPoles;
		if (stage.poleRadius[v] >= 0 && (sheet || isAhead)) {
			const double weight2 = sheet ? sheetWeight2 : wM2;
			D[i] = float(wH2 + weight2);
			b[i] = toPole * weight2;
		}
	});
	M.forEachProduct(
		Lv, [&](int i, const FloatQuad& sum) { b[i] -= Point3d(sum[0], sum[1], sum[2]); });
	progress.report(1, "Contracting");
	return system;
}

} // namespace vcg::tri::mcf

#endif
