// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What several filters share: parameters, surfaces with poles, results and log texts.

#ifndef MCFSKEL_FILTER_SUPPORT_H
#define MCFSKEL_FILTER_SUPPORT_H

#include "../filters.h"
#include "../layers/kept_stages.h"
#include "../layers/layers.h"

#include <skeleton/state.h>
#include <skeleton/support.h>

#include <memory>

namespace mcfskel {

/// "Mean Curvature Skeleton: " and the filter's own name.
QString menuName(const char* name);

/// The help page of a filter: what it does, and the publication behind it.
QString helpPage(const QString& whatItDoes);

// Parameters that more than one filter has.

ParameterSpec targetLengthParameter();
ParameterSpec resampleIterationsParameter();
ParameterSpec denoiseParameter();
/// adaptive and relative_length.
std::vector<ParameterSpec> adaptiveParameters();
ParameterSpec detailParameter(double standard);
ParameterSpec poleMethodParameter();
ParameterSpec repairParameter();
std::vector<ParameterSpec> weightParameters();
ParameterSpec epsilonParameter();
ParameterSpec splitAngleParameter();
ParameterSpec fixSelectedParameter();

// From values to the pipeline's parameters; each reads the ones of its filters.

void readResampling(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);
void readAdaptive(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);
/// epsilon, as a fraction of the diagonal; 0 stands for the default, which a script that serves
/// meshes of any size cannot know in mesh units.
double readEpsilon(const ParameterValues& values);
void readFlow(const ParameterValues& values, vcg::tri::mcf::Parameters& parameters);
vcg::tri::mcf::PoleMethod readPoleMethod(const ParameterValues& values);
vcg::tri::mcf::Repair readRepair(const ParameterValues& values);

// Reports, for Python and for the log.

Results stageResults(const vcg::tri::mcf::Stage& stage);
/// `repaired` (0: unchanged, 1: mended, 2: wrapped), the distances of the solid from the input in
/// percent of the diagonal, and how many triangles cross others and how many pieces are left out.
Results repairResults(const vcg::tri::mcf::SolidReport& report);
Results curveResults(const vcg::tri::mcf::CurveSkeleton& skeleton);
/// What is left of the surface's volume at a stage, such as "12.3 % of the volume".
QString partOfVolume(double fraction);
QString stageLine(const vcg::tri::mcf::StageFigures& figures);

/**
 * 1 for each selected vertex of the current surface layer; empty unless fix_selected is set.
 * @throws InvalidInput if it is set and no vertex is selected.
 */
std::vector<char> selectionToHold(const FilterRun& run, const SurfaceLayer& surface);

/// Where the state of a run's layers is looked for; valid as long as the run.
StateSources sourcesOf(const FilterRun& run);

/**
 * For filters that take surfaces: refuses a stage, or a copy of one. If the layer was a stage and
 * its state is lost, the log says why.
 * @throws InvalidInput
 */
void refuseStage(const FilterRun& run);

/// Writes the repairs of a surface into the log, once.
void logNotes(const FilterRun& run, const SurfaceLayer& surface);

/// Writes the library's notes into the log; valid as long as the run.
vcg::tri::mcf::NoteCallback noteLog(const FilterRun& run);

/// A new layer with this mesh, in which slots are vertices.
/// @param hollow see SurfaceLayer, as for `soundWith`.
SurfaceLayer compactSurface(std::shared_ptr<const vcg::tri::mcf::SurfaceMesh> mesh,
	std::shared_ptr<const vcg::tri::mcf::SurfaceMesh> hollow, vcg::tri::mcf::Repair soundWith);

/// A surface together with its poles.
struct PoledSurface
{
	SurfaceLayer surface;
	/// How the surface was repaired; if it isChanged(), the surface is no layer yet.
	vcg::tri::mcf::SolidReport solid;
	std::shared_ptr<const vcg::tri::mcf::PoleSet> poles;
	/// Whether the poles were computed just now, and are not on the layer yet.
	bool computed = false;
};

/// The poles that the current surface layer carries; if it has none, computes them and says so.
PoledSurface surfaceWithPoles(FilterRun& run, vcg::tri::mcf::PoleMethod method,
	vcg::tri::mcf::Repair repair, const vcg::tri::mcf::Progress& progress);

/// NAME_meso_K.
QString stageLabel(const QString& name, const vcg::tri::mcf::Stage& stage);

/// Adds a layer NAME_meso_K for each stage of a run, in the frame of its layer. @throws Cancelled
void addStages(DocumentEdit& edit, const FilterRun& run, KeptStages& stages,
	const SurfaceLink& surface, const vcg::tri::mcf::Progress& progress);

} // namespace mcfskel

#endif
