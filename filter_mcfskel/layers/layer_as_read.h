// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A layer of which something is known, until it is written on.

#ifndef MCFSKEL_LAYER_AS_READ_H
#define MCFSKEL_LAYER_AS_READ_H

#include "../host/host_api.h"

#include <skeleton/support.h>

#include <QString>

#include <array>
#include <cstddef>

namespace mcfskel {

/**
 * A layer by its id, and how many elements it had. The host lets the user go on whenever it is
 * called back, so that another layer may be the current one when a filter writes its results, and
 * the layer that it has read may be gone or have other vertices. No pointer or reference to a layer
 * is to be kept over a report of progress.
 */
class LayerAsRead
{
public:
	explicit LayerAsRead(const MeshModel& layer) :
			number(int(layer.id())), label(layer.label()), elements(elementsOf(layer.cm))
	{
	}

	int id() const { return number; }

	/// The layer now. @throws InvalidInput if it is gone or has other numbers of elements.
	MeshModel& in(MeshDocument& document) const
	{
		MeshModel* const layer = document.getMesh(number);
		if (!layer || elementsOf(layer->cm) != elements)
			throw vcg::tri::mcf::InvalidInput("The layer '" + label.toStdString()
				+ "' was deleted or changed while the filter ran: run the filter again.");
		return *layer;
	}

private:
	using Elements = std::array<size_t, 6>;

	/// The deleted ones and the others.
	static Elements elementsOf(const CMeshO& mesh)
	{
		return {mesh.vert.size(), mesh.edge.size(), mesh.face.size(), size_t(mesh.vn),
			size_t(mesh.en), size_t(mesh.fn)};
	}

	int number;
	QString label;
	Elements elements;
};

} // namespace mcfskel

#endif
