// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Labels on a surface: made connected, their borders made short and smooth.

#ifndef VCG_MCF_SEGMENTATION_LABELS_H
#define VCG_MCF_SEGMENTATION_LABELS_H

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/mesh/surface_mesh.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// A label in [0, labels) for each vertex of a surface, -1 where it is not known.
class PartLabels
{
public:
	/// @param surface kept by reference, compact. @throws Cancelled
	PartLabels(const SurfaceMesh& surface, std::vector<int> label, int labels,
		const Progress& progress = Progress()) :
			surface(surface),
			label(std::move(label)), labels(labels)
	{
		fillArray(vertexArea, size_t(surface.vertexSlots()), 0.0, progress);
		reportedLoop(surface.halfEdgeSlots(), progress, finding, [&](int h) {
			vertexArea[surface.origin(h)] += surface.doubleAreaVector(h / 3).Norm();
		});
	}

	int ofVertex(int v) const { return label[v]; }

	/**
	 * Makes every part connected: it keeps its largest piece, and the rest goes to the part that is
	 * nearest over edges. A component of the surface without any label gets none.
	 * @throws Cancelled
	 */
	void connect(const Progress& progress = Progress())
	{
		const auto forEachNeighbour = [&](int v, const auto& visit) {
			surface.forEachOutgoing(v, [&](int h) { visit(surface.target(h)); });
		};
		keepLargest(label, vertexArea, forEachNeighbour, progress.part(0, 0.5));
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
		reportedLoop(int(label.size()), progress.part(0.5, 0.7), finding, [&](int v) {
			if (label[v] >= 0)
				spread(v, 0);
		});
		Ticker ticker(progress.part(0.7, 1), finding, int(label.size()));
		while (!front.empty()) {
			ticker.tick();
			const auto [distance, v, candidate] = front.top();
			front.pop();
			if (label[v] >= 0)
				continue;
			label[v] = candidate;
			spread(v, distance);
		}
	}

	/// Shortens the borders between parts; no part loses its last vertex. @throws Cancelled
	void smooth(const Progress& progress)
	{
		constexpr int rounds = 12;
		const std::vector<int> innermost = innermostVertices(progress.part(0, 0.05));
		for (int round = 0; round < rounds; ++round) {
			const auto at = [&](double part) { return 0.05 + 0.95 * (round + part) / rounds; };
			const std::vector<int> band = bandAroundBorders(progress.part(at(0), at(0.3)));
			diffuse(band, progress.part(at(0.3), at(1)));
			for (int v : band)
				label[v] = largest(v);
			for (int part = 0; part < labels; ++part)
				if (innermost[part] >= 0)
					label[innermost[part]] = part;
		}
	}

	/**
	 * The part of each face: that of most of its corners, then made connected over edges; a face
	 * between two neighbours of one other part goes to that part.
	 * @throws Cancelled
	 */
	std::vector<int> ofFaces(const Progress& progress = Progress()) const
	{
		const size_t count = size_t(surface.faceSlots());
		std::vector<int> ofFace;
		std::vector<double> area;
		ofFace.reserve(count);
		area.reserve(count);
		reportedLoop(surface.faceSlots(), progress.part(0, 0.2), finding, [&](int f) {
			const Triangle t = surface.triangle(f);
			ofFace.push_back(label[t[1]] == label[t[2]] ? label[t[1]] : label[t[0]]);
			area.push_back(surface.doubleAreaVector(f).Norm());
		});
		const auto forEachNeighbour = [&](int f, const auto& visit) {
			for (int k = 0; k < 3; ++k)
				visit(surface.twin(3 * f + k) / 3);
		};
		keepLargest(ofFace, area, forEachNeighbour, progress.part(0.2, 0.5));
		std::vector<int> front;
		front.reserve(count);
		reportedLoop(surface.faceSlots(), progress.part(0.5, 0.6), finding, [&](int f) {
			if (ofFace[f] >= 0)
				front.push_back(f);
		});
		Ticker spreading(progress.part(0.6, 0.8), finding, int(count));
		for (size_t i = 0; i < front.size(); ++i) {
			spreading.tick();
			const int f = front[i]; // the array may move
			forEachNeighbour(f, [&](int g) {
				if (ofFace[g] < 0) {
					ofFace[g] = ofFace[f];
					front.push_back(g);
				}
			});
		}
		// Such a face shares one edge with its own part, which stays connected without it.
		std::vector<int> stack = numberedArray(count, progress);
		std::reverse(stack.begin(), stack.end());
		Ticker ticker(progress.part(0.8, 1), finding, int(count));
		while (!stack.empty()) {
			ticker.tick();
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
	/// Parts and their amounts at a vertex.
	using Mixture = std::vector<std::pair<int, double>>;

	static constexpr char finding[] = "Finding the parts", smoothing[] = "Smoothing the borders";

	const SurfaceMesh& surface;
	std::vector<int> label;
	int labels;
	std::vector<double> vertexArea;
	/// Empty except in the band where the labels are being diffused.
	std::vector<Mixture> mixture;

	/// Sets all elements to -1 except those of the largest connected piece of each label.
	template <class ForEachNeighbour>
	void keepLargest(std::vector<int>& of, const std::vector<double>& area,
		const ForEachNeighbour& forEachNeighbour, const Progress& progress) const
	{
		std::vector<int> piece = filledArray(of.size(), -1, progress), stack;
		Ticker ticker(progress.part(0, 0.8), finding, int(of.size()));
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
				ticker.tick();
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
		reportedLoop(int(of.size()), progress.part(0.8, 1), finding, [&](int v) {
			if (of[v] >= 0 && piece[v] != largestPiece[of[v]])
				of[v] = -1;
		});
	}

	bool isOnBorder(int v) const
	{
		bool border = false;
		surface.forEachOutgoing(
			v, [&](int h) { border = border || label[surface.target(h)] != label[v]; });
		return border;
	}

	/// Rings of neighbours that each vertex is away from a border, up to `maximum`; -1: farther.
	std::vector<int> ringsFromBorders(
		int maximum, std::vector<int>& order, const Progress& progress) const
	{
		std::vector<int> rings = filledArray(label.size(), -1, progress);
		order.clear();
		reportedLoop(int(label.size()), progress.part(0, 0.6), smoothing, [&](int v) {
			if (label[v] >= 0 && isOnBorder(v)) {
				rings[v] = 0;
				order.push_back(v);
			}
		});
		Ticker ticker(progress.part(0.6, 1), smoothing, int(label.size()));
		for (size_t i = 0; i < order.size(); ++i) {
			ticker.tick();
			const int v = order[i]; // the array may move
			if (rings[v] < maximum)
				surface.forEachOutgoing(v, [&](int h) {
					const int w = surface.target(h);
					if (rings[w] < 0) {
						rings[w] = rings[v] + 1;
						order.push_back(w);
					}
				});
		}
		return rings;
	}

	/// For each part a vertex as many rings from its borders as any; -1 if the part has no vertex.
	std::vector<int> innermostVertices(const Progress& progress) const
	{
		std::vector<int> order, innermost(size_t(labels), -1);
		const std::vector<int> rings =
			ringsFromBorders(int(label.size()), order, progress.part(0, 0.9));
		reportedLoop(int(label.size()), progress.part(0.9, 1), smoothing, [&](int v) {
			if (label[v] >= 0) {
				int& best = innermost[label[v]];
				if (best < 0 || rings[v] > rings[best])
					best = v;
			}
		});
		return innermost;
	}

	static constexpr int diffusionSteps = 12;

	std::vector<int> bandAroundBorders(const Progress& progress) const
	{
		std::vector<int> band;
		ringsFromBorders(diffusionSteps / 2, band, progress);
		return band;
	}

	/// Adds up a mixture in an array over all labels: many parts at one vertex need no search.
	class Sum
	{
	public:
		explicit Sum(int labels) : amount(size_t(labels), 0) {}

		void add(int part, double value)
		{
			if (amount[part] == 0)
				parts.push_back(part);
			amount[part] += value;
		}

		/// Returns the sum, parts in the order in which they were added, and resets it.
		Mixture take()
		{
			Mixture mixture;
			mixture.reserve(parts.size());
			for (int part : parts) {
				mixture.emplace_back(part, amount[part]);
				amount[part] = 0;
			}
			parts.clear();
			return mixture;
		}

	private:
		std::vector<double> amount;
		std::vector<int> parts;
	};

	/// Each step takes half of every vertex's mixture to its neighbours.
	void diffuse(const std::vector<int>& band, const Progress& progress)
	{
		fillArray(mixture, label.size(), Mixture(), progress);
		for (int v : band)
			mixture[v] = {{label[v], 1}};
		std::vector<Mixture> next(band.size());
		Sum sum(labels);
		Ticker ticker(progress, smoothing, diffusionSteps * int(band.size()));
		for (int step = 0; step < diffusionSteps; ++step) {
			for (size_t i = 0; i < band.size(); ++i) {
				ticker.tick();
				const int v = band[i];
				int degree = 0;
				surface.forEachOutgoing(v, [&](int) { ++degree; });
				for (const auto& [part, value] : mixture[v])
					sum.add(part, value / 2);
				surface.forEachOutgoing(v, [&](int h) {
					const int w = surface.target(h);
					if (mixture[w].empty())
						sum.add(label[w], 0.5 / degree);
					for (const auto& [part, value] : mixture[w])
						sum.add(part, value / (2 * degree));
				});
				next[i] = sum.take();
			}
			for (size_t i = 0; i < band.size(); ++i)
				mixture[band[i]] = std::move(next[i]);
		}
	}

	/// The part with the largest amount at a vertex; of equals the vertex's own, then the lowest.
	int largest(int v) const
	{
		int best = label[v];
		double maximum = 0;
		for (const auto& [part, value] : mixture[v])
			if (value > maximum
				|| (value == maximum && best != label[v] && (part < best || part == label[v]))) {
				best = part;
				maximum = value;
			}
		return best;
	}
};

} // namespace vcg::tri::mcf::detail

#endif
