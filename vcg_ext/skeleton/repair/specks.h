// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Specks: small pieces that float about a surface.

#ifndef VCG_MCF_SPECKS_H
#define VCG_MCF_SPECKS_H

#include "fill_holes.h"
#include "limb_ends.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>
#include <skeleton/mesh/surface_mesh.h>

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace vcg::tri::mcf::detail {

/// Pieces of a surface that are to be dropped.
struct Specks
{
	std::vector<char> isOne; ///< for each face whether its piece is a speck
	int count = 0;           ///< of specks
};

/// The specks of a surface, unless it is made of them. Open pieces are specks if they are small in
/// area; sheets may be larger, and flat ones, of which no filling makes a body, larger still.
/// Closed pieces are specks if they are small in size, or have no volume.
/// @param partner  as PartedSurface has it. @pre there are triangles. @throws Cancelled
inline Specks specksOf(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles,
	const std::vector<int>& partner, const Cancellation& cancel = Cancellation())
{
	constexpr double speck = 0.002, sheet = 0.01, flatSheet = 0.1; // of the whole area
	// |sum of area vectors| / area: half a sphere has 0.5, a flat piece 1
	constexpr double likeASheet = 0.25, flatAsSheet = 0.999;
	constexpr double smallest = 0.01, small = 0.05; // of the largest piece's diagonal
	constexpr double thin = 1e-4; // of the largest volume: a small piece with less is a speck
	// All specks, and all flat sheets, of the whole area: if they are more, they are the surface.
	constexpr double maxOfAll = 0.05, maxFlatness = 0.2;
	constexpr double flat = 1e-10; // volume over area^1.5
	const std::vector<int> piece = pieceOfFaces(partner, cancel);
	struct Piece
	{
		double area = 0, volume = 0;
		Point3d normal = Point3d(0, 0, 0);
		bool open = false;
		Box3d box;
	};
	std::map<int, Piece> pieces;
	double whole = 0, largest = 0, fullest = 0;
	const Point3d origin = points[size_t(triangles[0][0])];
	cancellableLoop(int(triangles.size()), cancel, [&](int i) {
		const size_t f = size_t(i);
		const Triangle& t = triangles[f];
		const Point3d a = points[size_t(t[0])] - origin, b = points[size_t(t[1])] - origin,
					  c = points[size_t(t[2])] - origin;
		Piece& p = pieces[piece[f]];
		const Point3d normal = ((b - a) ^ (c - a)) / 2.0;
		const double area = normal.Norm();
		p.area += area;
		p.normal += normal;
		whole += area;
		p.volume += a * (b ^ c) / 6;
		for (size_t k = 0; k < 3; ++k) {
			p.open |= partner[3 * f + k] < 0;
			p.box.Add(points[size_t(t[k])]);
		}
		largest = std::max(largest, p.box.Diag());
	});
	// That of an open piece depends on the origin: from the middle it is about what is enclosed.
	for (auto& [first, p] : pieces)
		if (p.open)
			p.volume -= (p.box.Center() - origin) * p.normal / 3;
	for (const auto& [first, p] : pieces)
		if (p.box.Diag() > small * largest)
			fullest = std::max(fullest, std::abs(p.volume));
	const auto isSpeck = [&](const Piece& p) {
		if (p.open)
			return p.area <= (p.normal.Norm() > likeASheet * p.area ? sheet : speck) * whole;
		return p.box.Diag() <= smallest * largest
			|| (p.box.Diag() <= small * largest && std::abs(p.volume) <= thin * fullest);
	};
	// Smaller ones, see isSpeck(), may be what is left of a surface with faces missing all over.
	const auto isFlat = [&](const Piece& p) {
		return p.open && p.area > sheet * whole && p.area <= flatSheet * whole
			&& p.normal.Norm() > flatAsSheet * p.area;
	};
	double specks = 0, flats = 0;
	for (const auto& [first, p] : pieces) {
		specks += isSpeck(p) ? p.area : 0;
		flats += isFlat(p) ? p.area : 0;
	}
	Specks found;
	std::set<int> drop;
	for (const auto& [first, p] : pieces)
		if ((isSpeck(p) && specks <= maxOfAll * whole)
			|| (isFlat(p) && flats <= maxFlatness * whole)
			|| (!p.open && std::abs(p.volume) <= flat * std::pow(p.area, 1.5)))
			drop.insert(first);
	found.isOne.assign(triangles.size(), 0);
	if (drop.size() == pieces.size())
		return found;
	found.count = int(drop.size());
	if (found.count > 0)
		cancellableLoop(int(triangles.size()), cancel,
			[&](int f) { found.isOne[size_t(f)] = drop.count(piece[size_t(f)]) > 0; });
	return found;
}

/// Unmarks the specks that are torn-off limbs, see isTornLimb(). @throws Cancelled
inline void spareTornLimbs(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const std::vector<int>& partner, Specks& specks,
	const Progress& progress)
{
	const std::vector<int> piece = pieceOfFaces(partner, progress);
	std::map<int, std::vector<int>> faces;
	std::vector<int> number = filledArray(triangles.size(), -1, progress); // within the piece
	cancellableLoop(int(triangles.size()), progress, [&](int i) {
		const size_t f = size_t(i);
		if (!specks.isOne[f])
			return;
		std::vector<int>& ofPiece = faces[piece[f]];
		number[f] = int(ofPiece.size());
		ofPiece.push_back(i);
	});
	for (const auto& [first, some] : faces) {
		std::vector<Triangle> own;
		std::vector<int> ownPartner;
		for (int f : some) {
			own.push_back(triangles[size_t(f)]);
			for (int h = 3 * f; h < 3 * f + 3; ++h) {
				const int g = partner[size_t(h)];
				ownPartner.push_back(g < 0 ? -1 : 3 * number[size_t(g) / 3] + g % 3);
			}
		}
		if (!isTornLimb(points, own, ownPartner, progress))
			continue;
		for (int f : some)
			specks.isOne[size_t(f)] = 0;
		--specks.count;
	}
}

/// Removes specks. @param partner  of the half-edges, is updated. @return how many specks.
/// @throws Cancelled
inline int dropSpecks(std::vector<Triangle>& triangles, std::vector<int>& partner,
	const Specks& specks, const Cancellation& cancel)
{
	if (!specks.count)
		return 0;
	std::vector<int> number = filledArray(triangles.size(), -1, cancel);
	int kept = 0;
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		if (!specks.isOne[size_t(f)])
			number[size_t(f)] = kept++;
	});
	std::vector<int> partnerLeft = filledArray(3 * size_t(kept), -1, cancel);
	cancellableLoop(int(partner.size()), cancel, [&](int i) {
		const size_t h = size_t(i);
		if (number[h / 3] >= 0 && partner[h] >= 0)
			partnerLeft[3 * size_t(number[h / 3]) + h % 3] =
				3 * number[size_t(partner[h]) / 3] + partner[h] % 3;
	});
	cancellableLoop(int(triangles.size()), cancel, [&](int f) {
		if (const int to = number[size_t(f)]; to >= 0)
			triangles[size_t(to)] = triangles[size_t(f)];
	});
	triangles.resize(size_t(kept));
	partner = std::move(partnerLeft);
	return specks.count;
}

inline int dropSpecks(const std::vector<Point3d>& points, std::vector<Triangle>& triangles,
	std::vector<int>& partner, const Cancellation& cancel)
{
	return dropSpecks(triangles, partner, specksOf(points, triangles, partner, cancel), cancel);
}

} // namespace vcg::tri::mcf::detail

#endif
