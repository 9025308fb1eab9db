// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A layer's state beyond its attributes; attributes by name and type. Internal to layers/.

#ifndef MCFSKEL_LAYER_STATE_H
#define MCFSKEL_LAYER_STATE_H

#include "attributes.h"
#include "layers.h"

#include <skeleton/support.h>
#include <skeleton/surface.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <typeindex>
#include <vector>

namespace mcfskel {

namespace mcf = vcg::tri::mcf;
using Allocator = vcg::tri::Allocator<CMeshO>;

constexpr char poleAttribute[] = "mcfskel_pole";
constexpr char poleRadiusAttribute[] = "mcfskel_pole_radius";
constexpr char fixedAttribute[] = "mcfskel_fixed";
constexpr char heldAttribute[] = "mcfskel_held";
constexpr char radiusAttribute[] = "mcfskel_radius";
constexpr char significanceAttribute[] = "mcfskel_significance";
constexpr char nodeAttribute[] = "mcfskel_node";
constexpr char kindAttribute[] = "mcfskel_kind";
constexpr char bridgeAttribute[] = "mcfskel_bridge";
constexpr char stateAttribute[] = "mcfskel_state";

/// The exact state of a layer, beyond its attributes. Immutable: copies share it.
struct LayerState
{
	/// fingerprint() of the geometry that the state belongs to.
	std::uint64_t fingerprint = 0;
	/// Surface layers.
	SurfaceLayer surface;
	std::shared_ptr<const mcf::PoleSet> poles;
	/// Stages.
	StageLayer stage;
	/// Skeletons.
	std::shared_ptr<const CurveLayer> curve;
	/// What 100 % of a Length was, mesh units, where a skeleton was made; 0: not known.
	double diagonal = 0;
};

using StatePointer = std::shared_ptr<const LayerState>;
using StateAttribute = MeshAttribute<StatePointer>;
using StateMark = StateAttribute::AttrType;

template <class Value>
void mix(std::uint64_t& hash, Value value)
{
	static_assert(sizeof(Value) <= sizeof(std::uint64_t));
	std::uint64_t word = 0;
	std::memcpy(&word, &value, sizeof value);
	hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
	hash ^= hash >> 29;
}

/// A number that changes with any coordinate, any corner, any edge and any deletion.
inline std::uint64_t fingerprint(const CMeshO& mesh)
{
	std::uint64_t hash = mesh.vert.size();
	for (const CVertexO& v : mesh.vert) {
		mix(hash, int(v.IsD()));
		for (int k = 0; k < 3; ++k)
			mix(hash, v.cP()[k]);
	}
	for (const CFaceO& f : mesh.face)
		for (int k = 0; k < 3; ++k)
			mix(hash, f.IsD() ? -1 : int(vcg::tri::Index(mesh, f.cV(k))));
	for (const CEdgeO& e : mesh.edge)
		for (int k = 0; k < 2; ++k)
			mix(hash, e.IsD() ? -1 : int(vcg::tri::Index(mesh, e.cV(k))));
	return hash;
}

/// Removes an attribute, if it is there. Unlike VCG's way to do so this needs no memory.
inline void removeAttribute(std::set<vcg::PointerToAttribute>& attributes, const char* name)
{
	const auto found = std::find_if(attributes.begin(), attributes.end(),
		[&](const vcg::PointerToAttribute& attribute) { return attribute._name == name; });
	if (found == attributes.end())
		return;
	delete found->_handle;
	attributes.erase(found);
}

/// VCG finds attributes by name and size alone and writes beyond the end where the size differs.
template <class T>
bool isOfType(const vcg::PointerToAttribute& attribute)
{
	return attribute._type == std::type_index(typeid(T)) && attribute._sizeof == int(sizeof(T));
}

/// The values of an attribute, for reading: VCG of 2020 hands out none from a constant mesh.
/// @pre isOfType<T>()
template <class T>
const T* valuesOf(const vcg::PointerToAttribute& attribute)
{
	return static_cast<const T*>(attribute._handle->DataBegin());
}

template <class T>
void requireType(
	const MeshModel& layer, const std::set<vcg::PointerToAttribute>& attributes, const char* name)
{
	const auto* attribute = findAttribute(attributes, name);
	if (attribute && !isOfType<T>(*attribute))
		throw mcf::InvalidInput("The layer '" + layer.label().toStdString() + "' has an attribute '"
			+ name + "' of another type, made by something else: remove it, or use another layer.");
}

/// Refuses a layer on which something else has used one of the project's names.
inline void requireOwnAttributes(const MeshModel& layer)
{
	requireType<Point3m>(layer, layer.cm.vert_attr, poleAttribute);
	for (const char* name : {poleRadiusAttribute, fixedAttribute, heldAttribute, radiusAttribute,
			 significanceAttribute, nodeAttribute, kindAttribute, bridgeAttribute})
		requireType<Scalarm>(layer, layer.cm.vert_attr, name);
	requireType<StateMark>(layer, layer.cm.vert_attr, stateAttribute);
}

/// Handle to a per-vertex attribute, added if missing. @throws InvalidInput: see requireType()
template <class T>
auto vertexAttribute(MeshModel& layer, const char* name)
{
	requireType<T>(layer, layer.cm.vert_attr, name);
	if (!findAttribute(layer.cm.vert_attr, name))
		addVertexAttribute<VertexAttribute<T>>(layer.cm, name);
	return Allocator::GetPerVertexAttribute<T>(layer.cm, name);
}

/// Where a layer's state is; null if it has none.
inline StateAttribute* findStateAttribute(const CMeshO& mesh)
{
	const auto* attribute = findAttribute(mesh.vert_attr, stateAttribute);
	return attribute && isOfType<StateMark>(*attribute)
		? static_cast<StateAttribute*>(attribute->_handle)
		: nullptr;
}

inline StatePointer findState(const CMeshO& mesh)
{
	const StateAttribute* attribute = findStateAttribute(mesh);
	return attribute ? attribute->content : nullptr;
}

/// The state of a layer, if its geometry is still what the state describes.
inline StatePointer validState(const MeshModel& layer)
{
	StatePointer state = findState(layer.cm);
	return state && state->fingerprint == fingerprint(layer.cm) ? state : nullptr;
}

/// @throws InvalidInput if a node of a skeleton is nowhere.
inline void requireUsablePlaces(const MeshModel& layer, const std::vector<vcg::Point3d>& nodes)
{
	const auto unusable = std::count_if(
		nodes.begin(), nodes.end(), [](const vcg::Point3d& p) { return !mcf::isUsablePlace(p); });
	if (unusable > 0)
		throw mcf::InvalidInput("The skeleton '" + layer.label().toStdString() + "' has "
			+ std::to_string(unusable)
			+ (unusable == 1 ? " node whose coordinates are" : " nodes whose coordinates are")
			+ " not finite, or too large: delete " + (unusable == 1 ? "it" : "them")
			+ ", or make the skeleton again.");
}

/// A state for a layer as it is now.
inline StatePointer newState(const MeshModel& layer, LayerState state)
{
	state.fingerprint = fingerprint(layer.cm);
	return std::make_shared<const LayerState>(std::move(state));
}

/// Where a layer's state is, added if missing. @throws InvalidInput: see requireType()
inline StateAttribute& stateOf(MeshModel& layer)
{
	requireType<StateMark>(layer, layer.cm.vert_attr, stateAttribute);
	StateAttribute* attribute = findStateAttribute(layer.cm);
	return attribute ? *attribute : addVertexAttribute<StateAttribute>(layer.cm, stateAttribute);
}

inline void setState(MeshModel& layer, LayerState state)
{
	stateOf(layer).content = newState(layer, std::move(state));
}

inline vcg::Point3d toDouble(const Point3m& p)
{
	return vcg::Point3d(p[0], p[1], p[2]);
}

inline Point3m toHost(const vcg::Point3d& p)
{
	return Point3m(Scalarm(p[0]), Scalarm(p[1]), Scalarm(p[2]));
}

inline vcg::Box3d liveBounds(const CMeshO& mesh)
{
	vcg::Box3d box;
	for (const CVertexO& v : mesh.vert)
		if (!v.IsD())
			box.Add(toDouble(v.cP()));
	return box;
}

/// Whether each corner of a face, or end of an edge, is a vertex that is not deleted. MeshLab's own
/// filters delete vertices without their edges, and then point these before the first vertex; files
/// may name vertices that are not there.
template <class Element>
bool hasVertices(const CMeshO& mesh, const Element& element)
{
	constexpr int corners = std::is_same_v<Element, CEdgeO> ? 2 : 3;
	for (int k = 0; k < corners; ++k) {
		const size_t slot = vcg::tri::Index(mesh, element.cV(k));
		if (slot >= mesh.vert.size() || mesh.vert[slot].IsD())
			return false;
	}
	return true;
}

/// The vertex slots of a layer that are not deleted, ascending.
inline std::vector<int> liveSlots(const CMeshO& mesh)
{
	std::vector<int> live;
	live.reserve(size_t(mesh.vn));
	for (size_t i = 0; i < mesh.vert.size(); ++i)
		if (!mesh.vert[i].IsD())
			live.push_back(int(i));
	return live;
}

} // namespace mcfskel

#endif
