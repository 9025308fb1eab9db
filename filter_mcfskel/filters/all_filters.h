// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The entry of each filter in the catalogue, one source file each.

#ifndef MCFSKEL_ALL_FILTERS_H
#define MCFSKEL_ALL_FILTERS_H

#include "../filters.h"

namespace mcfskel {

FilterSpec makeSolidFilter();
FilterSpec resampleFilter();
FilterSpec medialPolesFilter();
FilterSpec contractionStepFilter();
FilterSpec collapseToCurveFilter();
FilterSpec refineSkeletonFilter();
FilterSpec fullSkeletonizeFilter();
FilterSpec surfacePartsFilter();
FilterSpec pruneSkeletonFilter();
FilterSpec resampleSkeletonFilter();
FilterSpec compareSkeletonsFilter();
FilterSpec measureSkeletonFilter();
FilterSpec medialAxisFilter();
FilterSpec medialBallsFilter();
FilterSpec skeletonTubesFilter();
FilterSpec saveStageFilter();
FilterSpec loadStageFilter();
FilterSpec saveSkeletonFilter();
FilterSpec saveProjectFilter();

} // namespace mcfskel

#endif
