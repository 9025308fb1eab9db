// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief From the catalogue to MeshLab's parameters and filter classes, and back.

#ifndef MCFSKEL_TRANSLATE_H
#define MCFSKEL_TRANSLATE_H

#include "../filters.h"

namespace mcfskel::host {

/// The filter with this number, which is its place in the catalogue.
const FilterSpec& filterOf(int id);

/// A filter's parameters with their defaults for the current layer.
void addParameters(RichParameterList& list, const FilterSpec& filter, ParameterDocument& document);

/// The values of a filter's parameters; the defaults of those that the list lacks, as scripts lack
/// those that are newer than they are.
ParameterValues readParameters(
	const RichParameterList& list, const FilterSpec& filter, const MeshDocument& document);

FilterBase::FilterClass filterClass(const FilterSpec& filter);

} // namespace mcfskel::host

#endif
