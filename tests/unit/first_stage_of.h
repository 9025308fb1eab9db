// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The first stage of a surface whose poles nobody has found yet.

#ifndef MCFSKEL_TESTS_FIRST_STAGE_OF_H
#define MCFSKEL_TESTS_FIRST_STAGE_OF_H

#include <skeleton/flow/first_stage.h>
#include <skeleton/poles/poles.h>

inline vcg::tri::mcf::Stage firstStageOf(
	const vcg::tri::mcf::SurfaceMesh& surface, const vcg::tri::mcf::Parameters& parameters)
{
	using namespace vcg::tri::mcf;
	return firstStage(surface, parameters, medialPoles(surface, parameters.poleMethod));
}

#endif
