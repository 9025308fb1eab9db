// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief A shape and a curve in it, for the tests of single steps of the refinement.

#ifndef MCFSKEL_TESTS_CURVE_IN_SHAPE_H
#define MCFSKEL_TESTS_CURVE_IN_SHAPE_H

#include "curves.h"
#include "shapes.h"

#include <skeleton/core/large_arrays.h>
#include <skeleton/refine/known_clearances.h>

#include <vector>

/// A shape with a diagonal of about 1, and a curve in it.
class CurveInShape
{
public:
	CurveInShape(const shapes::Soup& soup, curves::CurveMaker maker) :
			mesh(soup.mesh()),
			vertices(vcg::tri::mcf::detail::numberedArray(mesh.position.size(), {})),
			closest(mesh, vertices, 0.01), curve(maker.in(mesh)), clearances(closest)
	{
	}

	std::vector<vcg::Point3d> tips() const { return curves::tips(curve); }

	const vcg::tri::mcf::SurfaceMesh mesh;
	const std::vector<int> vertices;
	const vcg::tri::mcf::ClosestSurface closest;
	vcg::tri::mcf::CurveSkeleton curve;
	vcg::tri::mcf::refining::KnownClearances clearances;
};

#endif
