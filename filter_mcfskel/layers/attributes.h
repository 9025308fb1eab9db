// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Attributes of layers that do not outlive their layer.
///
/// VCG never frees the attributes of a mesh that is destroyed: what they hold is lost to the process.
/// But TriMesh::Clear(), which the destructor calls, resizes the attributes of vertices to nothing in
/// releases since 2023.12 (in earlier ones all is lost as ever). An ordinary attribute keeps its memory
/// then; those here give it back, so that nothing of a layer stays but some 60 bytes for each attribute.
/// An attribute of the whole mesh gets no such call.
///
/// No list of layers is kept: a mesh may be swapped with another one, moved, cleared or destroyed by any
/// filter, in any document and any thread, and the attribute is always called by whoever owns it.

#ifndef MCFSKEL_ATTRIBUTES_H
#define MCFSKEL_ATTRIBUTES_H

#include "../host/host_api.h"

#include <memory>
#include <set>
#include <utility>

namespace mcfskel {

/// One value for each vertex slot; the memory is given back when the mesh is cleared.
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

/// What a MeshAttribute<Data> has at each vertex: a type of its own, to be told from all others.
template <class Data>
struct NoValue
{
	char unused;
};

/// One `Data` for the whole mesh, dropped when the mesh is cleared. To VCG it is an attribute of vertices,
/// sound in every way: whatever a host does to all of them may be done to it.
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
 * Adds an attribute of vertices as VCG does, with a handle that is a `Handle`.
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
