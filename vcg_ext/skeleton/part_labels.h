// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Labels on a surface: made connected, their borders made short and smooth.

#ifndef VCG_MCF_PART_LABELS_H
#define VCG_MCF_PART_LABELS_H

#include "progress.h"
#include "surface_mesh.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// A label in [0, labels) for each vertex of a surface, or -1: not known.
class PartLabels
{
public:
	/// @param surface kept by reference, compact.
	PartLabels(const SurfaceMesh& surface, std::vector<int> label, int labels) :
			surface(surface), label(std::move(label)), labels(labels),
			vertexArea(size_t(surface.vertexSlots()), 0)
	{
		for (int h = 0; h < surface.halfEdgeSlots(); ++h)
			vertexArea[surface.origin(h)] += surface.areaVector(h / 3).Norm();
	}

	int ofVertex(int v) const { return label[v]; }

	/**
	 * Makes every part connected: it keeps its largest piece, and what is left over goes to the part
	 * that is nearest over edges. A component of the surface without any label keeps none.
	 */
	void connect()
	{
		keepLargest(label, vertexArea, [&](int v, const auto& visit) {
			surface.forEachOutgoing(v, [&](int h) { visit(surface.target(h)); });
		});
		using Entry = std::tuple<double, int, int>; // distance, vertex, label
		std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> front;
		const auto spread = [&](int v, double distance) {
			surface.forEachOutgoing(v, [&](int h) {
				const int w = surface.target(h);
				if (label[w] < 0)
					front.emplace(
						distance + Distance(surface.position[v], surface.position[w]), w, label[v]);
			});
		};
		for (int v = 0; v < int(label.size()); ++v)
			if (label[v] >= 0)
				spread(v, 0);
		while (!front.empty()) {
			const auto [distance, v, candidate] = front.top();
			front.pop();
			if (label[v] >= 0)
				continue;
			label[v] = candidate;
			spread(v, distance);
		}
	}

	/// Shortens the borders between parts; no part loses its last vertex.
	void smooth(const Progress& progress)
	{
		constexpr int rounds = 12;
		const std::vector<int> innermost = innermostVertices();
		for (int round = 0; round < rounds; ++round) {
			progress.report(double(round) / rounds, "Smoothing the borders");
			const std::vector<int> band = bandAroundBorders();
			diffuse(band);
			for (int v : band)
				label[v] = largest(v);
			for (int part = 0; part < labels; ++part)
				if (innermost[part] >= 0)
					label[innermost[part]] = part;
		}
	}

	/**
	 * The part of each face: that of most of its corners, then made connected over edges and rid of
	 * faces that two neighbours of one other part have in between.
	 */
	std::vector<int> ofFaces() const
	{
		std::vector<int> ofFace(surface.faceSlots());
		std::vector<double> area(ofFace.size());
		for (int f = 0; f < surface.faceSlots(); ++f) {
			const Triangle t = surface.triangle(f);
			ofFace[f] = label[t[1]] == label[t[2]] ? label[t[1]] : label[t[0]];
			area[f] = surface.areaVector(f).Norm();
		}
		const auto forEachNeighbour = [&](int f, const auto& visit) {
			for (int k = 0; k < 3; ++k)
				visit(surface.twin(3 * f + k) / 3);
		};
		keepLargest(ofFace, area, forEachNeighbour);
		std::vector<int> front;
		for (int f = 0; f < int(ofFace.size()); ++f)
			if (ofFace[f] >= 0)
				front.push_back(f);
		for (size_t i = 0; i < front.size(); ++i)
			forEachNeighbour(front[i], [&](int g) {
				if (ofFace[g] < 0) {
					ofFace[g] = ofFace[front[i]];
					front.push_back(g);
				}
			});
		// Such a face hangs on its own part by one edge: without it that stays connected.
		std::vector<int> stack;
		for (int f = int(ofFace.size()) - 1; f >= 0; --f)
			stack.push_back(f);
		while (!stack.empty()) {
			const int f = stack.back();
			stack.pop_back();
			int other[3];
			for (int k = 0; k < 3; ++k)
				other[k] = ofFace[surface.twin(3 * f + k) / 3];
			for (int k = 0; k < 3; ++k) {
				const int a = other[k], b = other[(k + 1) % 3], own = other[(k + 2) % 3];
				if (a == b && a != ofFace[f] && own == ofFace[f]) {
					ofFace[f] = a;
					forEachNeighbour(f, [&](int g) { stack.push_back(g); });
					break;
				}
			}
		}
		return ofFace;
	}

private:
	/// How much of which part there is at a vertex.
	using Mixture = std::vector<std::pair<int, double>>;

	const SurfaceMesh& surface;
	std::vector<int> label;
	int labels;
	std::vector<double> vertexArea;
	/// Empty but in the band, where the labels are being diffused.
	std::vector<Mixture> mixture;

	/// Takes the label from all elements but those of the largest connected piece of each label.
	template <class ForEachNeighbour>
	void keepLargest(std::vector<int>& of, const std::vector<double>& area,
		const ForEachNeighbour& forEachNeighbour) const
	{
		std::vector<int> piece(of.size(), -1), stack;
		std::vector<double> pieceArea;
		std::vector<int> largestPiece(size_t(labels), -1);
		for (int seed = 0; seed < int(of.size()); ++seed) {
			if (of[seed] < 0 || piece[seed] >= 0)
				continue;
			const int id = int(pieceArea.size());
			pieceArea.push_back(0);
			piece[seed] = id;
			stack.assign(1, seed);
			while (!stack.empty()) {
				const int v = stack.back();
				stack.pop_back();
				pieceArea[id] += area[v];
				forEachNeighbour(v, [&](int w) {
					if (piece[w] < 0 && of[w] == of[v]) {
						piece[w] = id;
						stack.push_back(w);
					}
				});
			}
			int& best = largestPiece[of[seed]];
			if (best < 0 || pieceArea[id] > pieceArea[best])
				best = id;
		}
		for (size_t v = 0; v < of.size(); ++v)
			if (of[v] >= 0 && piece[v] != largestPiece[of[v]])
				of[v] = -1;
	}

	bool isOnBorder(int v) const
	{
		bool border = false;
		surface.forEachOutgoing(
			v, [&](int h) { border = border || label[surface.target(h)] != label[v]; });
		return border;
	}

	/// Rings of neighbours that each vertex is away from a border, up to `most`; -1: farther.
	std::vector<int> ringsFromBorders(int most, std::vector<int>& order) const
	{
		std::vector<int> rings(label.size(), -1);
		order.clear();
		for (int v = 0; v < int(label.size()); ++v)
			if (label[v] >= 0 && isOnBorder(v)) {
				rings[v] = 0;
				order.push_back(v);
			}
		for (size_t i = 0; i < order.size(); ++i)
			if (rings[order[i]] < most)
				surface.forEachOutgoing(order[i], [&](int h) {
					const int w = surface.target(h);
					if (rings[w] < 0) {
						rings[w] = rings[order[i]] + 1;
						order.push_back(w);
					}
				});
		return rings;
	}

	/// Of each part a vertex that is as far from its borders as any; -1 if the part has none.
	std::vector<int> innermostVertices() const
	{
		std::vector<int> order, innermost(size_t(labels), -1);
		const std::vector<int> rings = ringsFromBorders(int(label.size()), order);
		for (int v = 0; v < int(label.size()); ++v)
			if (label[v] >= 0) {
				int& best = innermost[label[v]];
				if (best < 0 || rings[v] > rings[best])
					best = v;
			}
		return innermost;
	}

	static constexpr int diffusionSteps = 12;

	std::vector<int> bandAroundBorders() const
	{
		std::vector<int> band;
		ringsFromBorders(diffusionSteps / 2, band);
		return band;
	}

	static void add(Mixture& sum, int part, double amount)
	{
		for (auto& [other, value] : sum)
			if (other == part) {
				value += amount;
				return;
			}
		sum.emplace_back(part, amount);
	}

	/// Each step takes half of every vertex's mixture to its neighbours.
	void diffuse(const std::vector<int>& band)
	{
		mixture.assign(label.size(), {});
		for (int v : band)
			mixture[v] = {{label[v], 1}};
		std::vector<Mixture> next(band.size());
		for (int step = 0; step < diffusionSteps; ++step) {
			for (size_t i = 0; i < band.size(); ++i) {
				const int v = band[i];
				Mixture sum;
				int degree = 0;
				surface.forEachOutgoing(v, [&](int) { ++degree; });
				for (const auto& [part, value] : mixture[v])
					add(sum, part, value / 2);
				surface.forEachOutgoing(v, [&](int h) {
					const int w = surface.target(h);
					if (mixture[w].empty())
						add(sum, label[w], 0.5 / degree);
					for (const auto& [part, value] : mixture[w])
						add(sum, part, value / (2 * degree));
				});
				next[i] = std::move(sum);
			}
			for (size_t i = 0; i < band.size(); ++i)
				mixture[band[i]] = std::move(next[i]);
		}
	}

	/// The part of which there is most at a vertex; of equals its own, then the lowest.
	int largest(int v) const
	{
		int best = label[v];
		double most = 0;
		for (const auto& [part, value] : mixture[v])
			if (value > most
				|| (value == most && best != label[v] && (part < best || part == label[v]))) {
				best = part;
				most = value;
			}
		return best;
	}
};

} // namespace vcg::tri::mcf::detail

#endif
