// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Files with other values in their fields: for the tests of the readers, and for their fuzz targets.

#ifndef MCFSKEL_TESTS_CHANGED_FIELDS_H
#define MCFSKEL_TESTS_CHANGED_FIELDS_H

#include <skeleton/io/binary_ply.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace changed_fields {

using namespace vcg::tri::mcf;

/// A value near another one of a column, or far from all that it should hold.
inline double changedValue(const PlyColumn& column, double value, std::mt19937& random)
{
	const auto below = [&](size_t n) { return size_t(random() % n); };
	const auto other = [&] { return column.values[below(column.values.size())]; };
	constexpr double special[] = {0, -0.0, 1, -1, 2, 3, 0.5, -0.5, 255, 256, 65535, 2147483647.0,
		-2147483648.0, 4294967295.0, 1e9, 1e-9, 1e30, -1e30, 1e36, 1.1e36, 1e38, 1e155, 1e228,
		1e-30, 1e-36, 1e-155, 5e-324, INFINITY, -INFINITY, NAN};
	switch (below(8)) {
	case 0: return special[below(std::size(special))];
	case 1: return value + double(int(below(5)) - 2);
	case 2: return -value;
	case 3: return value * std::pow(10, double(int(below(21)) - 10));
	case 4: return value * (1 + (double(below(2001)) - 1000) / 1000);
	case 5: return std::nextafter(value, below(2) ? INFINITY : -INFINITY);
	default: return other();
	}
}

/// A value that a type can hold, as writing takes it: conversions beyond are undefined.
inline double held(double value, PlyType type)
{
	if (type == PlyType::Double)
		return value;
	if (type == PlyType::Float)
		return std::abs(value) <= 3e38 || !std::isfinite(value) ? value : INFINITY;
	return std::abs(value) <= 1e15 ? std::trunc(value) : 0;
}

/// Changes up to three columns of the tables of a file, mostly one value each. Values fit the columns' types.
/// @return whether it was a file with any.
inline bool changeTables(PlyFile& ply, std::mt19937& random)
{
	std::vector<PlyColumn*> columns;
	for (PlyElement& element : ply.elements)
		for (PlyColumn& column : element.columns)
			if (!column.values.empty())
				columns.push_back(&column);
	if (columns.empty())
		return false;
	for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
		PlyColumn& column = *columns[random() % columns.size()];
		const size_t i = random() % column.values.size();
		if (random() % 8 == 0) {
			// All of them: a shape that is flat, turned over, far away.
			const double value = changedValue(column, column.values[i], random);
			const unsigned how = random() % 3;
			for (double& v : column.values)
				v = how == 0 ? value : how == 1 ? v * value : v + value;
		}
		else
			column.values[i] = changedValue(column, column.values[i], random);
	}
	for (PlyColumn* column : columns)
		for (double& value : column->values)
			value = held(value, column->type);
	return true;
}

/// A text with one of its fields, the words between blanks, changed.
inline std::string withOtherField(const std::string& text, std::mt19937& random)
{
	static const std::vector<std::string> words = {"0", "-0", "1", "-1", "2", "7", "1.5", "1e36",
		"1.1e36", "-1e37", "1e228", "1e400", "5e-324", "nan", "inf", "-inf", "2147483647",
		"2147483648", "-2147483649", "0x10", "+3", "1,5", "", "v", "e", "#", "x", "\n", "1 1", "-"};
	std::vector<size_t> start;
	for (size_t i = 0; i < text.size(); ++i)
		if (!std::isspace(text[i]) && (i == 0 || std::isspace(text[i - 1])))
			start.push_back(i);
	if (start.empty())
		return text;
	const size_t from = start[random() % start.size()];
	const size_t end = std::min(text.find_first_of(" \n", from), text.size());
	return text.substr(0, from) + words[random() % words.size()] + text.substr(end);
}

} // namespace changed_fields

#endif
