// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Stages and skeletons of layers, with the edits made since a filter made them, and where
/// their state is looked for if it is not on the layer.

#include "stored_state.h"

#include <skeleton/pipeline.h>

#include <QRegularExpression>
#include <QStringList>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace mcfskel {

namespace {

QString quoted(const MeshModel& layer)
{
	return "'" + layer.label() + "'";
}

bool fitsLayer(const StatePointer& state, const MeshModel& layer)
{
	if (!state)
		return false;
	if (state->stage)
		return hasTrianglesOf(layer, *state->stage.stage);
	return state->curve && hasEdgesOf(layer, state->curve->skeleton);
}

bool isUnmoved(const LayerState& state, const MeshModel& layer)
{
	return movedFrom(layer,
			   state.stage ? state.stage.stage->mesh.position : state.curve->skeleton.position)
			   .count
		== 0;
}

/// The state of a stage or skeleton: the layer's own; else that of a layer of the same geometry,
/// such as the original of a copy; else that in the file that the layer was loaded from.
StatePointer foundState(const MeshModel& layer, const StateSources& sources)
{
	if (StatePointer own = findState(layer.cm)) {
		if (fitsLayer(own, layer))
			return own;
		if (own->stage || own->curve)
			return nullptr;
	}
	for (const MeshModel* other : host::layersOf(sources.document)) {
		StatePointer state = other == &layer ? nullptr : findState(other->cm);
		if (fitsLayer(state, layer) && isUnmoved(*state, layer)) {
			sources.note("The layer " + quoted(layer) + " is a copy of " + quoted(*other)
				+ " and is taken for the same, with all that is known of it.");
			return state;
		}
	}
#if MCFSKEL_FILES
	StatePointer stored = storedState(layer);
	if (stored)
		sources.note(
			"What is known of the layer " + quoted(layer) + " was read from its file again.");
	return stored;
#else
	return nullptr;
#endif
}

/// The values of an attribute; null if it is not there or of a foreign type.
template <class T>
const T* attributeValues(const MeshModel& layer, const char* name)
{
	const auto* attribute = findAttribute(layer.cm.vert_attr, name);
	return attribute && isOfType<T>(*attribute) ? valuesOf<T>(*attribute) : nullptr;
}

/// Applies the edits on a layer to its stage, which is copied at the first change.
class StageEditor
{
public:
	StageEditor(const MeshModel& layer, std::shared_ptr<const mcf::Stage> stage) :
			layer(layer), original(std::move(stage))
	{
	}

	/// @throws InvalidStage
	std::shared_ptr<const mcf::Stage> result(const StateSources& sources)
	{
		requireOwnAttributes(layer);
		takePositions();
		takePoles();
		takeMarks();
		if (!copy)
			return original;
		copy->converged = false; // until the next step has looked
		mcf::checkStage(*copy);
		sources.note(
			"Taken over from what was edited on " + quoted(layer) + ": " + what.join(", ") + ".");
		return std::make_shared<const mcf::Stage>(*std::move(copy));
	}

private:
	const MeshModel& layer;
	std::shared_ptr<const mcf::Stage> original;
	std::optional<mcf::Stage> copy;
	QStringList what;

	mcf::Stage& edited()
	{
		if (!copy)
			copy = *original;
		return *copy;
	}

	void count(int edits, const char* of)
	{
		if (edits > 0)
			what << QString("%1 %2").arg(edits).arg(of);
	}

	void takePositions()
	{
		const std::vector<vcg::Point3d>& before = original->mesh.position;
		const Moved moved = movedFrom(layer, before);
		if (moved.count == 0)
			return;
		mcf::Stage& stage = edited();
		for (size_t v = 0; v < before.size(); ++v)
			if (layer.cm.vert[v].cP() != toHost(before[v]))
				stage.mesh.position[v] = toDouble(layer.cm.vert[v].cP());
		const mcf::Extent extent = mcf::measuredExtent(
			stage.mesh, stage.component, std::vector<double>(stage.diagonal.size(), 1));
		stage.area = extent.area;
		stage.volume = extent.volume;
		what << QString("%1 positions (by up to %2)")
					.arg(moved.count)
					.arg(moved.farthest, 0, 'g', 3);
	}

	void takePoles()
	{
		int poles = 0, radii = 0;
		if (const auto* pole = attributeValues<Point3m>(layer, poleAttribute))
			for (size_t v = 0; v < original->pole.size(); ++v)
				if (pole[v] != toHost(original->pole[v])) {
					edited().pole[v] = toDouble(pole[v]);
					++poles;
				}
		if (const auto* radius = attributeValues<Scalarm>(layer, poleRadiusAttribute))
			for (size_t v = 0; v < original->poleRadius.size(); ++v)
				if (radius[v] != Scalarm(original->poleRadius[v])) {
					edited().poleRadius[v] = radius[v] < 0 ? -1 : double(radius[v]);
					++radii;
				}
		count(poles, "poles");
		count(radii, "radii of poles");
	}

	/// Sets the marks of one kind to those of an attribute; returns how many were different.
	int takeMarks(const char* name, std::vector<char> mcf::Stage::*marks)
	{
		const auto* shown = attributeValues<Scalarm>(layer, name);
		if (!shown)
			return 0;
		int edits = 0;
		for (size_t v = 0; v < (original.get()->*marks).size(); ++v) {
			if (!std::isfinite(shown[v]))
				throw mcf::InvalidStage(mcf::InvalidStage::Part::Vertex, v, 1,
					"'" + std::string(name) + "' is no number.");
			const char mark = shown[v] != 0;
			if (mark == (original.get()->*marks)[v])
				continue;
			(edited().*marks)[v] = mark;
			++edits;
		}
		return edits;
	}

	void takeMarks()
	{
		count(takeMarks(fixedAttribute, &mcf::Stage::fixed), "fixed marks");
		count(takeMarks(heldAttribute, &mcf::Stage::held), "held marks");
		// A held vertex is fixed, whatever its mark says.
		if (copy)
			mcf::holdVertices(*copy, std::vector<char>(copy->held));
	}
};

} // namespace

StageLayer readStage(const MeshModel& layer, const StateSources& sources)
{
	const StatePointer state = layer.cm.fn > 0 ? foundState(layer, sources) : nullptr;
	if (!state || !state->stage)
		return {};
	StageLayer found = state->stage;
	found.stage = StageEditor(layer, std::move(found.stage)).result(sources);
	return found;
}

QString lostState(const MeshModel& layer)
{
	static const QRegularExpression stageName("_meso_\\d+(?!\\d)");
	const StatePointer state = findState(layer.cm);
	if (state && state->stage)
		return "The triangles of the layer " + quoted(layer)
			+ ", a stage of the contraction, were changed: what was known of it, such as its iterations and "
			  "the poles of its surface, is lost.";
	const bool hasMarks = findAttribute(layer.cm.vert_attr, fixedAttribute) != nullptr;
	if (hasMarks || (layer.cm.fn > 0 && layer.label().contains(stageName)))
		return "The layer " + quoted(layer) + (hasMarks ? " has attributes" : " has the name")
			+ " of a stage of the contraction, but its state is gone, as in files of MeshLab's own: only those "
			  "that 'Save Stage' and 'Save Project' write keep it.";
	return {};
}

CurveLayer readCurve(const MeshModel& layer, const StateSources& sources)
{
	const StatePointer state = layer.cm.fn == 0 ? foundState(layer, sources) : nullptr;
	if (!state || !state->curve) {
		const StatePointer own = findState(layer.cm);
		CurveLayer curve = readCurve(layer);
		if (own && own->curve && !own->curve->skeleton.node.empty())
			sources.note("The nodes or edges of " + quoted(layer)
				+ " were changed: which vertices of its surface belong to which node is lost.");
		return curve;
	}
	CurveLayer curve = *state->curve;
	mcf::CurveSkeleton& skeleton = curve.skeleton;
	QStringList edits;
	if (const Moved moved = movedFrom(layer, skeleton.position); moved.count > 0) {
		for (size_t v = 0; v < skeleton.position.size(); ++v)
			if (layer.cm.vert[v].cP() != toHost(skeleton.position[v]))
				skeleton.position[v] = toDouble(layer.cm.vert[v].cP());
		requireUsablePlaces(layer, skeleton.position);
		edits << QString("%1 positions (by up to %2)")
					 .arg(moved.count)
					 .arg(moved.farthest, 0, 'g', 3);
	}
	const auto take = [&](const char* attribute, std::vector<double>& values, const char* of) {
		const auto* shown = attributeValues<Scalarm>(layer, attribute);
		int changed = 0;
		for (size_t v = 0; shown && v < values.size(); ++v)
			if (shown[v] != Scalarm(values[v])) {
				values[v] = double(shown[v]);
				++changed;
			}
		if (changed > 0)
			edits << QString("%1 %2").arg(changed).arg(of);
	};
	take(radiusAttribute, skeleton.radius, "radii");
	take(significanceAttribute, skeleton.significance, "significances");
	for (double& significance : skeleton.significance)
		significance = significance >= 0 ? std::min(significance, 1.0) : 0; // NaN, too
	if (!edits.isEmpty())
		sources.note(
			"Taken over from what was edited on " + quoted(layer) + ": " + edits.join(", ") + ".");
	return curve;
}

MeshModel* layerOf(MeshDocument& document, const SurfaceLink& link)
{
	if (!link.vertexOfSlot)
		return nullptr;
	const auto isIt = [&](const MeshModel* layer) {
		return layer && layer->cm.vert.size() == link.vertexOfSlot->size()
			&& fingerprint(layer->cm) == link.fingerprint;
	};
	if (MeshModel* own = link.layerId < 0 ? nullptr : document.getMesh(link.layerId); isIt(own))
		return own;
	for (const MeshModel* layer : host::layersOf(document))
		if (isIt(layer))
			return document.getMesh(int(layer->id()));
	return nullptr;
}

} // namespace mcfskel
