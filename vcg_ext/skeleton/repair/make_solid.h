// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The closed surface of the solid that triangles describe, with few changes if possible.

#ifndef VCG_MCF_MAKE_SOLID_H
#define VCG_MCF_MAKE_SOLID_H

#include "surface_layers.h"
#include "cut_handles.h"
#include "mend.h"
#include "overlap.h"
#include "solid_measures.h"
#include "solid_pieces.h"
#include "solid_report.h"
#include "thicken_sheets.h"
#include "winding_number.h"
#include "wrap.h"

#include <skeleton/core/errors.h>
#include <skeleton/core/notes.h>
#include <skeleton/core/parameters.h>
#include <skeleton/core/progress.h>
#include <skeleton/input/check_input.h>
#include <skeleton/mesh/surface_rounding.h>
#include <skeleton/spatial/integer_winding.h>
#include <skeleton/spatial/nearest_points.h>
#include <skeleton/spatial/transferred_nodes.h>
#include <skeleton/spatial/triangle_tree.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

namespace detail {

/// Bounds of SolidReport::overlap: from the first on, the surface is wrapped; below the second, its
/// crossings are due to rounding.
constexpr double noticeableOverlap = 0.002, smallestOverlap = 1e-5;

/// Bodies that share walls of more than this part of the area are wrapped into one.
constexpr double noticeableWalls = 0.002;

/// Layers of an open surface that are no farther apart than this part of the diagonal count as one.
constexpr double layersApart = 0.01;

/// Bounds of the spacing s of a wrap's lattice: the surface has the area of this many squares of
/// side s.
constexpr double usualSquares = 30000, maxSquares = 150000;

/// Thickness in spacings of the finest lattice, see SolidMaker::cellsAcross(): from the first on, a
/// surface is wrapped; from the second on, if the wrap turns out to lose nothing.
constexpr double cellsOfThick = 2.5, fewestCells = 1.2;

/// Leaves out cavities, and pieces with less volume than two lattice cubes, except the largest.
/// @return the number of small pieces; the cavities, and the surface with them.
inline std::pair<int, LeftOutPieces> dropSmallPieces(
	WrappedSurface& surface, double spacing, const Progress& progress)
{
	const SurfaceMesh mesh(surface.points, surface.triangles, progress.part(0, 0.5));
	const ClosedPieces pieces(mesh, progress.part(0.5, 1));
	const std::vector<double>& volume = pieces.volume;
	const double largest = *std::max_element(volume.begin(), volume.end());
	const double minimum = std::min(2 * spacing * spacing * spacing, largest);
	std::vector<Triangle> kept;
	for (const Triangle& t : surface.triangles)
		if (volume[size_t(pieces.ofVertex[size_t(t[0])])] >= minimum)
			kept.push_back(t);
	surface.triangles = std::move(kept);
	LeftOutPieces leftOut;
	leftOut.cavities =
		int(std::count_if(volume.begin(), volume.end(), [&](double v) { return v <= -minimum; }));
	if (leftOut.cavities > 0)
		leftOut.hollow = std::make_shared<const SurfaceMesh>(mesh.copied(progress));
	return {int(std::count_if(
				volume.begin(), volume.end(), [&](double v) { return std::abs(v) < minimum; })),
		leftOut};
}

/// Makes the solid; one object for each input.
class SolidMaker
{
public:
	SolidMaker(const std::vector<Point3d>& points, const std::vector<Triangle>& triangles) :
			points(points), triangles(triangles)
	{
	}

	/// @param sheetThickness  see SolidChoices.
	SolidSurface run(Repair repair, double sheetThickness, const Progress& progress)
	{
		requireParameter(
			sheetThickness >= 0 && std::isfinite(sheetThickness), "sheet_thickness", "at least 0");
		const bool isThickened = sheetThickness > 0 && repair != Repair::Off;
		std::optional<InvalidInput> error;
		try {
			solid.surface = checkedSurface(
				points, triangles, repair == Repair::Off ? progress : progress.part(0, 0.3));
		}
		catch (const InvalidInput& found) {
			if (!isMended(found.defect()))
				throw;
			if (found.defect() != Defect::NotFinite && isFlat(points, triangles)) {
				if (isThickened)
					return thickened(sheetThickness, repair, progress.part(0.3, 1));
				refuse(found, true);
			}
			if (repair == Repair::Off)
				throw;
			error = found;
		}
		if (repair == Repair::Off)
			return std::move(solid);
		if (!error) {
			if (repair == Repair::Auto
				&& isToBeWrapped(solid.surface.mesh, solid.surface.turned, fewestCells,
					solid.surface.notes, progress.part(0.3, 0.4)))
				wrapSound(progress.part(0.4, 1));
			return std::move(solid);
		}
		MendedSurface mended = mend(points, triangles, HoleLimits(), progress.part(0.3, 0.5));
		solid.report.mended = mended.report;
		if (mended.closed) {
			// On a copy: a wrap cuts handles of its own result.
			MendedSurface whole = mended;
			solid.report.handles =
				cutHandles(whole.points, whole.triangles, HandleLimits(), progress.part(0.5, 0.55));
			if (takeMended(whole, repair, progress.part(0.55, 0.6)))
				return std::move(solid);
		}
		if (repair == Repair::Mend || mended.triangles.empty())
			throw InvalidInput(*error);
		if (mended.report.facesTurned > 0)
			takeSidesAsGiven(mended, progress.part(0.6, 0.65));
		try {
			wrapIt(mended.points, std::move(mended.triangles), error, progress.part(0.65, 1));
		}
		catch (const InvalidInput& found) {
			if (!isThickened || found.defect() != Defect::OpenSheet)
				throw;
			return thickened(sheetThickness, repair, progress.part(0.9, 1));
		}
		return std::move(solid);
	}

private:
	const std::vector<Point3d>& points;
	const std::vector<Triangle>& triangles;
	SolidSurface solid;
	/// cellsAcross() of a surface that is to be wrapped.
	double cells = 0;

	/// The surface around an open sheet, see thickenedSheets(); wrapped where that crosses itself.
	SolidSurface thickened(double thickness, Repair repair, const Progress& progress)
	{
		const Box3d box =
			boundsOfFaces(points, finiteFaces(points, triangles, progress), progress.cancelOnly());
		ThickenedSheets sheets =
			thickenedSheets(points, triangles, thickness * box.Diag(), progress.part(0, 0.3));
		MendedSurface thick;
		thick.points = roundedCoordinates(sheets.points, sheets.triangles, progress.cancelOnly());
		thick.triangles = std::move(sheets.triangles);
		thick.vertexOfInput = std::move(sheets.vertexOfInput);
		thick.closed = true;
		solid = {};
		solid.report.sheetThickness = thickness;
		if (!takeMended(thick, repair, progress.part(0.3, 0.6)))
			wrapIt(thick.points, std::move(thick.triangles), {}, progress.part(0.6, 1));
		return std::move(solid);
	}

	/// Whether surfaces with this defect are mended or wrapped.
	static bool isMended(Defect defect)
	{
		switch (defect) {
		case Defect::NotFinite:
		case Defect::NonManifoldEdges:
		case Defect::NonManifoldVertices:
		case Defect::OneSided:
		case Defect::BorderEdges:
		case Defect::NoVolume:
		case Defect::Flat: return true;
		case Defect::Other:
		case Defect::Empty:
		case Defect::NoFaces:
		case Defect::OpenSheet: break;
		}
		return false;
	}

	/// Wraps a sound surface. Keeps it, with a note, if the wrap fails, cuts bodies, see
	/// isCutInWrap(), or joins none where no noticeable part of the volume is enclosed more than
	/// once; where it is thin, also if there are more pieces then, or some of it is left out.
	void wrapSound(const Progress& progress)
	{
		constexpr double mayBeLeftOut = 0.02; // of the area
		SolidSurface asItIs = std::exchange(solid, {});
		const SurfaceMesh& mesh = asItIs.surface.mesh;
		solid.report = asItIs.report;
		// All pieces are turned outward: the wrap fills these cavities.
		LeftOutPieces& leftOut = solid.report.leftOut;
		if (std::optional<SurfaceMesh> hollow = withCavitiesInward(
				mesh, asItIs.surface.turned, leftOut.cavities, progress.cancelOnly()))
			leftOut.hollow = std::make_shared<const SurfaceMesh>(*std::move(hollow));
		const ClosedPieces bodies(mesh, progress.cancelOnly());
		const int before = int(bodies.count()) - leftOut.cavities;
		const auto keepAsItIs = [&](const std::string& why) {
			solid = std::move(asItIs);
			solid.surface.notes.push_back(
				"Bodies touch or cross each other. The surface is left as it is: " + why);
		};
		try {
			wrapIt(mesh.position, mesh.triangles(), {}, progress.part(0, 0.95));
		}
		catch (const SolverError&) {
			return keepAsItIs("a wrap of it would be too large.");
		}
		catch (const InvalidInput&) {
			return keepAsItIs("a wrap of it would enclose nothing.");
		}
		const SurfaceMesh& wrapped = solid.surface.mesh;
		const ClosedPieces pieces(wrapped, progress.cancelOnly());
		const auto after = std::count_if(
			pieces.volume.begin(), pieces.volume.end(), [](double v) { return v > 0; });
		const bool isJoined = after < before || asItIs.report.overlap >= noticeableOverlap;
		if (isCutInWrap(mesh, bodies, wrapped, pieces, progress.part(0.95, 1)))
			keepAsItIs("a wrap would cut thin ones.");
		else if (cells < cellsOfThick
			&& (after > before
				|| partLeftOut(mesh, wrapped, 2 * latticeSpacing(mesh.position, mesh.triangles()),
					   progress.cancelOnly())
					> mayBeLeftOut))
			keepAsItIs("a wrap would lose its thin parts.");
		else if (!isJoined)
			keepAsItIs("a wrap would not join them.");
	}

	/// Whether bodies share walls, or the surface crosses itself and a noticeable part of the solid
	/// is enclosed more than once; and it is not too thin to be wrapped. Adds a note if a surface
	/// that crosses itself is kept.
	/// @param turned  see CheckedSurface::turned.
	/// @param minCells  below so many cellsAcross() it is too thin.
	bool isToBeWrapped(const SurfaceMesh& mesh, const std::vector<char>& turned, double minCells,
		std::vector<std::string>& notes, const Progress& progress)
	{
		const std::vector<Triangle> faces = mesh.triangles(progress);
		SolidReport& report = solid.report;
		// Outward, as the check has turned them, cavities would count as enclosed twice.
		int cavities = 0;
		const std::optional<SurfaceMesh> hollow =
			withCavitiesInward(mesh, turned, cavities, progress.cancelOnly());
		const std::vector<Triangle> inward =
			hollow ? hollow->triangles(progress) : std::vector<Triangle>();
		report.overlap =
			windingVolumes(mesh.position, hollow ? inward : faces, 128, progress.part(0, 0.3))
				.wrongPart();
		int pieces = 0;
		connectedComponents(mesh, &pieces, progress.cancelOnly());
		if (report.overlap < smallestOverlap && pieces == 1)
			return false;
		const TriangleTree tree(mesh.position, faces, progress.part(0.3, 0.4));
		const auto isTooThin = [&](const Progress& part) {
			cells = cellsAcross(mesh.position, faces, tree, part);
			return cells < minCells;
		};
		if (pieces > 1
			&& sharedWalls(mesh.position, faces, tree, progress.part(0.4, 0.5)) > noticeableWalls
			&& !isTooThin(progress.cancelOnly()))
			return true;
		if (report.overlap < smallestOverlap)
			return false;
		report.selfIntersections =
			selfIntersections(mesh.position, faces, tree, progress.part(0.5, 0.9));
		if (!report.selfIntersections) // bodies inside bodies
			return false;
		const bool isNoticeable = report.overlap >= noticeableOverlap;
		if (isNoticeable && !isTooThin(progress.part(0.9, 1)))
			return true;
		notes.push_back(sentence(3, report.selfIntersections,
			report.selfIntersections == 1 ? " triangle crosses others; "
										  : " triangles cross others; ",
			100 * report.overlap,
			" % of the volume is enclosed more than once. The surface is left as it is: ",
			isNoticeable ? "a wrap would lose its thin parts." : "that is little."));
		return false;
	}

	/// The spacing of a wrap's finest lattice, mesh units.
	static double latticeSpacing(
		const std::vector<Point3d>& points, const std::vector<Triangle>& faces)
	{
		double area = 0;
		for (const Triangle& t : faces)
			area += areaVector(points, t).Norm();
		return std::sqrt(area / maxSquares);
	}

	/// The thickness that a tenth of the surface is below, in spacings of a wrap's finest lattice; up
	/// to twice cellsOfThick.
	static double cellsAcross(const std::vector<Point3d>& points,
		const std::vector<Triangle>& faces, const TriangleTree& tree, const Progress& progress)
	{
		constexpr int samples = 4000;
		constexpr double part = 0.1; // of the area
		const double spacing = latticeSpacing(points, faces);
		return smallThickness(placesByArea(points, faces, samples), tree, true, part,
				   2 * cellsOfThick * spacing, progress)
			/ spacing;
	}

	bool takeMended(const MendedSurface& mended, Repair repair, const Progress& progress)
	{
		CheckedSurface checked;
		try {
			checked = checkedSurface(mended.points, mended.triangles, progress.part(0, 0.4));
		}
		catch (const InvalidInput&) {
			return false; // flat
		}
		std::vector<std::string> notes;
		if (repair == Repair::Auto
			&& isToBeWrapped(
				checked.mesh, checked.turned, cellsOfThick, notes, progress.part(0.4, 0.6)))
			return false;
		std::vector<int> vertexOfInput;
		vertexOfInput.reserve(points.size());
		for (int v : mended.vertexOfInput)
			vertexOfInput.push_back(checked.vertexOfInput[size_t(v)]);
		solid.report.outcome = SolidReport::Mended;
		finish(std::move(checked.mesh), std::move(vertexOfInput), progress.part(0.6, 1));
		solid.surface.turned = std::move(checked.turned);
		solid.surface.notes.insert(solid.surface.notes.end(), notes.begin(), notes.end());
		return true;
	}

	/// Enclosure::enclosing with closed pieces, and then the whole surface, turned outward.
	static double enclosingPart(
		const std::vector<Point3d>& given, std::vector<Triangle> faces, const Progress& progress)
	{
		constexpr int samples = 2000;
		turnOutward(given, faces, progress.part(0, 0.2));
		const TriangleTree tree(given, faces, progress.part(0.2, 0.4));
		const double diagonal = tree.allNodes()[0].box.Diag();
		const std::vector<double> weights =
			layerWeights(tree, isOfOpenPiece(given, faces, progress.part(0.4, 0.5)),
				layersApart * diagonal, progress.part(0.5, 0.6));
		const auto enclosure = [&](const Progress& part) {
			return enclosureOf(placesByArea(given, faces, samples),
				WindingNumber(tree, part.part(0, 0.3), weights), diagonal, part.part(0.3, 1));
		};
		const Enclosure found = enclosure(progress.part(0.6, 0.8));
		if (found.outward >= 0)
			return found.enclosing;
		for (Triangle& t : faces)
			std::swap(t[1], t[2]);
		return enclosure(progress.part(0.8, 1)).enclosing;
	}

	/// Takes the faces as they were given, if more of the area encloses then: where scans overlap,
	/// seams between layers may have made mend() turn faces inward that faced outward.
	void takeSidesAsGiven(MendedSurface& mended, const Progress& progress)
	{
		constexpr double better = 0.02; // of the area
		std::vector<Triangle> faces = finiteFaces(points, triangles, progress);
		removeDegenerateFaces(points.size(), faces, progress.part(0, 0.1));
		std::vector<int> partner =
			pairedHalfEdges(mended.points, faces, nullptr, progress.part(0.1, 0.2));
		if (faces.empty() || mended.triangles.empty())
			return;
		dropSpecks(mended.points, faces, partner, progress);
		if (enclosingPart(mended.points, faces, progress.part(0.2, 0.6))
			> enclosingPart(mended.points, mended.triangles, progress.part(0.6, 1)) + better) {
			mended.triangles = std::move(faces);
			solid.report.mended = MendReport();
		}
	}

	/// @param error  of checkedSurface(); none for a sound surface. Thrown if there is no volume.
	void wrapIt(const std::vector<Point3d>& given, std::vector<Triangle> faces,
		const std::optional<InvalidInput>& error, const Progress& progress)
	{
		constexpr int samples = 4000;
		constexpr double ofThickness = 0.4, thinPart = 0.05; // of the area
		constexpr int maxNodes = 6000000;
		Box3d box;
		double area = 0;
		for (const Triangle& t : faces) {
			for (int v : t)
				box.Add(given[size_t(v)]);
			area += areaVector(given, t).Norm();
		}
		if (!(area > 0)) {
			if (error)
				throw InvalidInput(*error);
			refuse(error, true);
		}
		turnOutward(given, faces, progress.part(0, 0.05));
		TriangleTree tree(given, faces, progress.part(0.05, 0.1));
		std::vector<SurfacePlace> places = placesByArea(given, faces, samples);
		const std::vector<char> isOpen = isOfOpenPiece(given, faces, progress.cancelOnly());
		const std::vector<double> weights =
			layerWeights(tree, isOpen, layersApart * box.Diag(), progress.cancelOnly());
		const bool isClosed = std::find(isOpen.begin(), isOpen.end(), 1) == isOpen.end();
		const auto enclosureNow = [&](const Progress& part) {
			if (isClosed)
				return enclosureOf(
					places, [&](const Point3d& p) { return double(integerWinding(tree, p)); },
					box.Diag(), part);
			const WindingNumber winding(tree, part.part(0, 0.4), weights);
			return enclosureOf(places, winding, box.Diag(), part.part(0.4, 1));
		};
		Enclosure enclosure = enclosureNow(progress.part(0.1, 0.15));
		if (enclosure.outward < 0) {
			for (Triangle& t : faces)
				std::swap(t[1], t[2]);
			for (SurfacePlace& place : places)
				place.normal = -place.normal;
		}
		const WindingNumber winding(tree, progress.part(0.15, 0.17), weights);
		if (enclosure.outward < 0)
			enclosure = enclosureNow(progress.part(0.17, 0.2));
		if (enclosure.enclosing < 0.1)
			refuse(error, isFlat(given, faces));
		const double widest = std::sqrt(area / usualSquares),
					 narrowest = std::sqrt(area / maxSquares);
		const double thin = smallThickness(
			places, tree, isClosed, thinPart, widest / ofThickness, progress.part(0.2, 0.25));
		const double spacing = std::clamp(ofThickness * thin, narrowest, widest);
		WrappedSurface made = wrap(tree, winding, spacing, maxNodes, progress.part(0.25, 0.8));
		if (made.triangles.empty())
			refuse(error, false);
		solid.report.outcome = SolidReport::Wrapped;
		solid.report.spacing = spacing / box.Diag();
		LeftOutPieces cavities;
		std::tie(solid.report.piecesDropped, cavities) =
			dropSmallPieces(made, spacing, progress.part(0.8, 0.85));
		if (LeftOutPieces& leftOut = solid.report.leftOut; leftOut.cavities > 0)
			leftOut.cavities += cavities.cavities; // in the surface as given all are outside
		else
			leftOut = std::move(cavities);
		solid.report.handles =
			cutHandles(made.points, made.triangles, HandleLimits(), progress.part(0.85, 0.87));
		CheckedSurface checked = checkedSurface(roundedCoordinates(made.points, made.triangles),
			made.triangles, progress.part(0.87, 0.9));
		finish(std::move(checked.mesh), std::vector<int>(points.size(), -1), progress.part(0.9, 1));
	}

	/// Whether all faces lie in one plane, as those of a drawing.
	static bool isFlat(const std::vector<Point3d>& given, const std::vector<Triangle>& faces)
	{
		constexpr double rounding = 1e-6; // of the diagonal
		Point3d normal(0, 0, 0);
		Box3d box;
		for (const Triangle& t : faces) {
			const Point3d n = areaVector(given, t);
			if (n.SquaredNorm() > normal.SquaredNorm())
				normal = n;
			for (int v : t)
				box.Add(given[size_t(v)]);
		}
		const Point3d& origin = given[size_t(faces[0][0])];
		const double maximum = rounding * box.Diag() * normal.Norm();
		return std::all_of(faces.begin(), faces.end(), [&](const Triangle& t) {
			return std::all_of(t.begin(), t.end(),
				[&](int v) { return std::abs((given[size_t(v)] - origin) * normal) <= maximum; });
		});
	}

	[[noreturn]] static void refuse(const std::optional<InvalidInput>& error, bool flat)
	{
		if (error && (error->defect() == Defect::NoVolume || error->defect() == Defect::Flat))
			throw InvalidInput(*error);
		throw InvalidInput(flat
				? "The mesh is flat, an open sheet in one plane: it bounds no solid that a "
				  "skeleton could lie in. Give it a thickness first."
				: "The surface is an open sheet: it bounds no solid that a skeleton could lie "
				  "in. Give it a thickness first, or close it.",
			Defect::OpenSheet);
	}

	/// Takes over the mesh, gives input vertices with faces that lost their vertex the closest one,
	/// and measures the distances.
	void finish(SurfaceMesh mesh, std::vector<int> vertexOfInput, const Progress& progress)
	{
		std::vector<char> used(points.size(), 0);
		const std::vector<Triangle> finite = finiteFaces(points, triangles, progress);
		Box3d box;
		for (const Triangle& t : finite)
			for (int v : t) {
				used[size_t(v)] = 1;
				box.Add(points[size_t(v)]);
			}
		std::vector<Point3d> lost;
		std::vector<size_t> whose;
		for (size_t v = 0; v < points.size(); ++v) {
			if (!used[v])
				continue;
			if (vertexOfInput[v] < 0) {
				lost.push_back(points[v]);
				whose.push_back(v);
			}
		}
		const std::vector<int> nearest =
			nearestPoints(mesh.position, lost, meanEdgeLength(mesh), progress.part(0, 0.3));
		for (size_t i = 0; i < lost.size(); ++i)
			vertexOfInput[whose[i]] = nearest[i];

		// Vertices that kept their place lie on both surfaces, at distance 0.
		std::vector<char> kept(mesh.position.size(), 0);
		std::vector<Point3d> left, made;
		size_t all = 0;
		for (size_t v = 0; v < points.size(); ++v) {
			if (!used[v])
				continue;
			++all;
			const size_t own = size_t(vertexOfInput[v]);
			if (mesh.position[own] == points[v])
				kept[own] = 1;
			else
				left.push_back(points[v]);
		}
		for (size_t v = 0; v < kept.size(); ++v)
			if (!kept[v])
				made.push_back(mesh.position[v]);
		const std::vector<Triangle> faces = mesh.triangles(progress);
		const Distances there =
			distances(made, mesh.position.size(), points, finite, progress.part(0.3, 0.65));
		const Distances back = distances(left, all, mesh.position, faces, progress.part(0.65, 1));
		SolidReport& report = solid.report;
		report.distanceMean = std::max(there.mean, back.mean) / box.Diag();
		report.distanceMax = std::max(there.greatest, back.greatest) / box.Diag();
		solid.surface.mesh = std::move(mesh);
		solid.surface.vertexOfInput = std::move(vertexOfInput);
		solid.surface.turned.clear();
		solid.surface.notes = {report.text()};
	}
};

} // namespace detail

/**
 * The closed, oriented, two-manifold surface of the solid that triangles describe.
 *
 * A surface that checkedSurface() accepts stays bit for bit as that returns it, unless it crosses
 * itself so that a noticeable part of its volume is enclosed more than once, or its bodies share
 * walls. Then it is wrapped by its winding number, see wrap(), unless a noticeable part of it is
 * too thin, or the wrap cuts bodies, or joins none where no volume is enclosed more than once. A
 * surface that checkedSurface() refuses is mended if its defects are small, see mend(), else
 * wrapped.
 *
 * @param points    mesh units. @param triangles corners as indices into `points`.
 * @param choices   repair: Auto: as above; Mend: no wrap; Off: checkedSurface() alone. For pieces
 *                  that are left out see keepSolidPieces(). An open sheet gets a thickness, if one is
 *                  given, see thickenedSheets().
 * @throws InvalidInput if there is no solid: no faces, no volume, an open sheet; the error of
 *         checkedSurface() if `repair` allows no cure. InvalidParameter for a negative thickness. SolverError if a wrap needs too many lattice
 *         nodes; Cancelled.
 * Complexity: for a sound surface as checkedSurface(), with `repair` Auto also as windingVolumes()
 * and selfIntersections(); else as mend() and wrap().
 */
inline SolidSurface solidSurface(const std::vector<Point3d>& points,
	const std::vector<Triangle>& triangles, const SolidChoices& choices = SolidChoices(),
	const Progress& progress = Progress())
{
	SolidSurface solid = detail::SolidMaker(points, triangles)
							 .run(choices.repair, choices.sheetThickness, progress.part(0, 0.95));
	const Cavities cavities = !choices.withoutCavities ? Cavities::Kept
		: choices.repair == Repair::Off                ? Cavities::Reported
													   : Cavities::LeftOut;
	const LeftOutPieces ofWrap = std::exchange(solid.report.leftOut, {});
	for (std::string& note : ofWrap.notes())
		solid.surface.notes.push_back(std::move(note));
	LeftOutPieces& leftOut = solid.report.leftOut =
		keepSolidPieces(solid.surface, choices.minComponent, cavities, progress.part(0.95, 1));
	leftOut.cavities += ofWrap.cavities;
	if (!leftOut.hollow)
		leftOut.hollow = ofWrap.hollow;
	return solid;
}

} // namespace vcg::tri::mcf

#endif
