// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Attributes of layers whose memory is freed with their layer.
///
/// VCG never frees the attributes of a mesh that is destroyed: their memory leaks. But since
/// release 2023.12 TriMesh::Clear(), which the destructor calls, resizes the attributes of vertices
/// to 0 (in earlier releases all of them leak). An ordinary attribute keeps its memory even then;
/// those here free it, so that only some 60 bytes for each attribute of a layer leak. An attribute
/// of the whole mesh gets no such call.
///
/// No list of layers is kept: any filter may swap, move, clear or destroy a mesh, in any document
/// and any thread, and the mesh that owns an attribute always calls it.

#ifndef MCFSKEL_ATTRIBUTES_H
#define MCFSKEL_ATTRIBUTES_H

#include "../host/host_api.h"

#include <memory>
#include <set>
#include <utility>

namespace mcfskel {

/// One value for each vertex slot; the memory is freed when the mesh is cleared.
template <class T>
class VertexAttribute : public vcg::SimpleTempData<CMeshO::VertContainer, T>
{
public:
	using Base = vcg::SimpleTempData<CMeshO::VertContainer, T>;
	using Base::Base;

	void Resize(size_t size) override
	{
		if (size > 0)
			Base::Resize(size);
		else
			this->data = decltype(this->data)();
	}
};

/// The placeholder that a MeshAttribute<Data> has at each vertex. Its type identifies it.
template <class Data>
struct NoValue
{
	char unused;
};

/// One `Data` for the whole mesh, dropped when the mesh is cleared. To VCG it is a regular
/// attribute of vertices: a host may do to it whatever it does to all of them.
template <class Data>
class MeshAttribute : public VertexAttribute<NoValue<Data>>
{
public:
	using Base = VertexAttribute<NoValue<Data>>;
	using Base::Base;

	Data content;

	void Resize(size_t size) override
	{
		Base::Resize(size);
		if (size == 0)
			content = Data();
	}
};

/// Finds an attribute by name in one of a mesh's attribute sets; null if there is none.
inline const vcg::PointerToAttribute* findAttribute(
	const std::set<vcg::PointerToAttribute>& attributes, const char* name)
{
	vcg::PointerToAttribute key;
	key._name = name;
	const auto found = attributes.find(key);
	return found == attributes.end() ? nullptr : &*found;
}

/**
 * Adds an attribute of vertices as VCG does, but stored in a `Handle`.
 * @pre the mesh has none of that name.
 */
template <class Handle>
Handle& addVertexAttribute(CMeshO& mesh, const char* name)
{
	using Allocator = vcg::tri::Allocator<CMeshO>;
	auto handle = std::make_unique<Handle>(mesh.vert);
	const auto added =
		Allocator::template AddPerVertexAttribute<typename Handle::AttrType>(mesh, name);
	auto entry = mesh.vert_attr.extract(*findAttribute(mesh.vert_attr, name));
	entry.value()._handle = handle.get();
	mesh.vert_attr.insert(std::move(entry));
	delete added._handle;
	return *handle.release();
}

} // namespace mcfskel

#endif
