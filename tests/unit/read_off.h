// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Reads a triangle mesh of meshes/ (plain OFF).

#ifndef MCFSKEL_TESTS_READ_OFF_H
#define MCFSKEL_TESTS_READ_OFF_H

#include "shapes.h"

#include <fstream>
#include <stdexcept>
#include <string>

namespace shapes {

/// @param name of a file in the folder MCFSKEL_MESHES, without its extension.
inline Soup fromFile(const std::string& name)
{
	const std::string path = std::string(MCFSKEL_MESHES) + "/" + name + ".off";
	std::ifstream file(path);
	std::string magic;
	size_t points = 0, triangles = 0, edges = 0;
	file >> magic >> points >> triangles >> edges;
	Soup s;
	s.points.resize(points);
	for (Point3d& p : s.points)
		file >> p[0] >> p[1] >> p[2];
	s.triangles.resize(triangles);
	for (Triangle& t : s.triangles) {
		int corners = 0;
		file >> corners >> t[0] >> t[1] >> t[2];
	}
	if (!file || magic != "OFF")
		throw std::runtime_error("cannot read " + path);
	return s;
}

} // namespace shapes

#endif
