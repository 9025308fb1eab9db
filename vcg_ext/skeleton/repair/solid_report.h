// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What was done to make the surface of a solid, and what may be done.

#ifndef VCG_MCF_SOLID_REPORT_H
#define VCG_MCF_SOLID_REPORT_H

#include "mend.h"
#include "solid_pieces.h"

#include <skeleton/core/notes.h>
#include <skeleton/core/parameters.h>
#include <skeleton/mesh/surface_mesh.h>

#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// What was done to make a surface that of a solid. Lengths are fractions of the input's diagonal.
struct SolidReport
{
	enum Outcome {
		Sound,  ///< nothing, but for the repairs of checkedSurface()
		Mended, ///< see mend()
		Wrapped ///< see wrap()
	};

	Outcome outcome = Sound;
	MendReport mended;
	/// Pieces of the wrap that were left out as specks.
	int piecesDropped = 0;
	/// Handles that were cut, see cutHandles().
	int handles = 0;
	/// Triangles that cross others, counted only if `overlap` is at least smallestOverlap; and the
	/// part of the volume enclosed more than once or inside out, see WindingVolumes::wrongPart().
	int selfIntersections = 0;
	double overlap = 0;
	/// Pieces that get no skeleton, see keepSolidPieces(), and the cavities of a wrap.
	LeftOutPieces leftOut;
	/// Distances of the result's vertices from the input and of the input's from the result: the
	/// larger mean, and the maximum.
	double distanceMean = 0, distanceMax = 0;
	/// Edge length of the wrap; 0 if there is none.
	double spacing = 0;
	/// What an open sheet was given, see thickenedSheets(); 0 if there is none.
	double sheetThickness = 0;

	/// Whether the surface differs from that of checkedSurface().
	bool isChanged() const { return outcome != Sound || leftOut.any(); }

	/// One sentence for the log; empty for a sound surface, even if pieces are left out.
	std::string text() const
	{
		if (outcome == Sound)
			return "";
		std::vector<std::string> what;
		const auto add = [&](int count, const char* one, const char* many) {
			if (count)
				what.push_back(std::to_string(count) + ' ' + (count == 1 ? one : many));
		};
		add(mended.facesDropped, "face dropped", "faces dropped");
		add(mended.verticesMerged, "vertex merged", "vertices merged");
		add(mended.junctionsClosed, "T-junction closed", "T-junctions closed");
		add(mended.edgesParted, "edge parted", "edges parted");
		add(mended.verticesParted, "vertex parted", "vertices parted");
		add(mended.facesTurned, "face turned", "faces turned");
		add(mended.gapsBridged, "gap bridged", "gaps bridged");
		add(mended.holesClosed, "hole closed", "holes closed");
		add(mended.piecesDropped + piecesDropped, "piece dropped", "pieces dropped");
		add(handles, "small handle cut", "small handles cut");
		if (outcome == Wrapped)
			add(selfIntersections, "triangle that crosses others resolved",
				"triangles that cross others resolved");
		const auto percent = [](double part) { return detail::number(100 * part, 2) + " %"; };
		if (sheetThickness > 0)
			what.push_back("an open sheet given a thickness of " + percent(sheetThickness));
		std::string list;
		for (const std::string& item : what)
			list += (list.empty() ? "" : ", ") + item;
		return (outcome == Mended ? std::string("The surface was mended")
								  : "The surface was wrapped by winding numbers, with edges of "
						   + percent(spacing) + " of its diagonal")
			+ (list.empty() ? "" : ": " + list) + "; the solid is " + percent(distanceMean)
			+ " of the diagonal from the input on average, " + percent(distanceMax) + " at most.";
	}
};

/// What solidSurface() is to do.
struct SolidChoices
{
	Repair repair;
	/// Pieces with less than this fraction of the largest one's volume are left out; 0: none are.
	double minComponent;
	/// Cavities are left out: there is no skeleton in them. Where `repair` is Off they stay, and a
	/// note says so. A wrap leaves them out in any case.
	bool withoutCavities;
	/// The thickness that an open sheet gets, as a fraction of its diagonal, >= 0; 0: it is refused,
	/// as it is where `repair` is Off.
	double sheetThickness;

	// NOLINTNEXTLINE(google-explicit-constructor): callers write the choices in braces.
	SolidChoices(Repair repair = Repair::Auto, double minComponent = 0,
		bool withoutCavities = false, double sheetThickness = 0) :
			repair(repair),
			minComponent(minComponent), withoutCavities(withoutCavities),
			sheetThickness(sheetThickness)
	{
	}
};

/// A surface that bounds a solid, and what was done to it.
struct SolidSurface
{
	/// Where mending or wrapping lost an input vertex, `vertexOfInput` is the closest vertex of the
	/// solid; -1 for a vertex without faces, or of a piece that is left out.
	CheckedSurface surface;
	SolidReport report;
};

} // namespace vcg::tri::mcf

#endif
