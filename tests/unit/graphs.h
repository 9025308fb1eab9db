// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Skeletons made by hand for the tests of the file formats, and what to do to their files.

#ifndef MCFSKEL_TESTS_GRAPHS_H
#define MCFSKEL_TESTS_GRAPHS_H

#include <skeleton/graph/curve_skeleton.h>

#include <skeleton/io/format_error.h>

#include <functional>
#include <random>
#include <sstream>
#include <string>

namespace graphs {

using namespace vcg::tri::mcf;
using vcg::Point3d;

/**
 * Two components: a ring of nodes 0 to 4 with a tail 5, 6 at node 2, thinnest between 3 and 4; and a
 * Y of nodes 7 to 10 around 7. Coordinates that no short decimal has.
 */
inline CurveSkeleton ringWithTailAndY()
{
	CurveSkeleton s;
	for (int i = 0; i < 11; ++i)
		s.position.emplace_back(std::sqrt(2.0) * i, 1.0 / (3 + i), -1e-17 * i + 1e5 / 7);
	s.radius = {0.5, 0.4, 0.9, 0.1, 0.11, 0.3, 0.2, 0.7, 0.6, 0.5, 0.7};
	s.edges = {{0, 1}, {0, 4}, {1, 2}, {2, 3}, {2, 5}, {3, 4}, {5, 6}, {7, 8}, {7, 9}, {7, 10}};
	s.node = {10, 0, 0, 3, -1, 7};
	return s;
}

/// What `write` puts into a stream.
inline std::string written(const std::function<void(std::ostream&)>& write)
{
	std::ostringstream out;
	write(out);
	return out.str();
}

/// The line of the FormatError that reading a text throws; 0 if it throws none.
template <class Read>
size_t errorLine(Read&& read, const std::string& text)
{
	std::istringstream in(text);
	try {
		read(in);
	}
	catch (const FormatError& error) {
		return error.line();
	}
	return 0;
}

/// Calls `read` with damaged copies of a file: cut short, with changed bits, with bytes moved.
inline void readDamaged(
	const std::string& file, int times, const std::function<void(std::istream&)>& read)
{
	std::mt19937 random(7);
	const auto below = [&](size_t n) {
		return std::uniform_int_distribution<size_t>(0, n - 1)(random);
	};
	for (int i = 0; i < times; ++i) {
		std::string damaged = file;
		if (i % 3 == 0)
			damaged.resize(below(damaged.size()));
		else if (i % 3 == 1)
			for (size_t flips = 1 + below(4); flips > 0; --flips)
				damaged[below(damaged.size())] ^= char(1 << below(8));
		else {
			const std::string piece = damaged.substr(below(damaged.size()), 1 + below(16));
			damaged.insert(below(damaged.size()), piece);
		}
		std::istringstream in(damaged);
		read(in);
	}
}

} // namespace graphs

#endif
