// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Vectors to the columns of a PLY file and back; reading checks the values.

#ifndef VCG_MCF_PLY_TABLES_H
#define VCG_MCF_PLY_TABLES_H

#include "binary_ply.h"

#include <vcg/space/point3.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vcg::tri::mcf {

/// Adds columns PREFIXx, PREFIXy, PREFIXz in double.
inline void addPoints(
	PlyElement& element, const std::string& prefix, const std::vector<Point3d>& points)
{
	std::vector<double> values(points.size());
	for (int axis = 0; axis < 3; ++axis) {
		for (size_t i = 0; i < points.size(); ++i)
			values[i] = points[i][axis];
		element.add(prefix + "xyz"[axis], PlyType::Double, values);
	}
}

/// Adds a column of lists of N integers.
template <size_t N>
void addTuples(
	PlyElement& element, const std::string& name, const std::vector<std::array<int, N>>& tuples)
{
	PlyColumn column {name, PlyType::Int32, N, {}};
	for (const std::array<int, N>& tuple : tuples)
		column.values.insert(column.values.end(), tuple.begin(), tuple.end());
	element.columns.push_back(std::move(column));
}

/// Adds two columns with the halves of a number of 64 bits, which no type of PLY holds.
inline void addFingerprint(PlyElement& element, std::uint64_t fingerprint)
{
	element.add("fingerprint_low", PlyType::UInt32,
		std::array<double, 1> {double(fingerprint & 0xFFFFFFFF)});
	element.add(
		"fingerprint_high", PlyType::UInt32, std::array<double, 1> {double(fingerprint >> 32)});
}

/// The values of an element of a PLY file, checked except by any...(). Errors name the place.
class PlyTable
{
public:
	/// @throws FormatError if the file has no such element.
	PlyTable(const PlyFile& file, const std::string& name) : element(file.find(name))
	{
		if (!element)
			throw FormatError::atRow(name, 0, "the file has no such element.");
	}

	size_t rows() const { return element->rows; }
	bool has(const std::string& column) const { return element->find(column) != nullptr; }

	FormatError error(size_t row, const std::string& what) const
	{
		return FormatError::atRow(element->name, row, what);
	}

	/// Finite numbers not below `minimum`.
	std::vector<double> reals(
		const std::string& name, double minimum = -std::numeric_limits<double>::infinity()) const
	{
		const PlyColumn& column = scalars(name);
		for (size_t row = 0; row < rows(); ++row)
			if (!std::isfinite(column.values[row]) || column.values[row] < minimum)
				throw bad(row, name, column.values[row]);
		return column.values;
	}

	/// Numbers unchecked; they may be infinite or NaN.
	const std::vector<double>& anyReals(const std::string& name) const
	{
		return scalars(name).values;
	}

	/// Integers in [minimum, maximum].
	std::vector<int> integers(const std::string& name, int minimum, int maximum) const
	{
		return checkedIntegers(scalars(name), 1, minimum, maximum);
	}

	/// Points from the columns PREFIXx, PREFIXy, PREFIXz, unchecked like anyReals().
	std::vector<Point3d> anyPoints(const std::string& prefix) const
	{
		std::vector<Point3d> result(rows());
		for (int axis = 0; axis < 3; ++axis) {
			const std::vector<double>& values = anyReals(prefix + "xyz"[axis]);
			for (size_t row = 0; row < rows(); ++row)
				result[row][axis] = values[row];
		}
		return result;
	}

	/// Lists of N integers in [minimum, maximum].
	template <size_t N>
	std::vector<std::array<int, N>> tuples(const std::string& name, int minimum, int maximum) const
	{
		const PlyColumn* column = element->find(name);
		if (rows() > 0 && (!column || column->listLength != N))
			throw error(0, "there is no list of " + std::to_string(N) + " in '" + name + "'.");
		std::vector<std::array<int, N>> result(rows());
		if (rows() == 0)
			return result;
		const std::vector<int> values = checkedIntegers(*column, N, minimum, maximum);
		for (size_t row = 0; row < rows(); ++row)
			for (size_t i = 0; i < N; ++i)
				result[row][i] = values[N * row + i];
		return result;
	}

private:
	const PlyColumn& scalars(const std::string& name) const
	{
		const PlyColumn* column = element->find(name);
		if (!column || column->listLength)
			throw error(0, "there is no property '" + name + "' of one number.");
		return *column;
	}

	FormatError bad(size_t row, const std::string& name, double value) const
	{
		return error(row, "'" + name + "' is " + numberText(value) + ", which cannot be.");
	}

	std::vector<int> checkedIntegers(
		const PlyColumn& column, size_t perRow, int minimum, int maximum) const
	{
		std::vector<int> result(column.values.size());
		for (size_t i = 0; i < result.size(); ++i) {
			const double value = column.values[i];
			// Negated, so that NaN fails as well.
			if (!(value >= minimum && value <= maximum) || value != std::floor(value))
				throw bad(i / perRow, column.name, value);
			result[i] = int(value);
		}
		return result;
	}

	const PlyElement* element;
};

/// What addFingerprint() added to the one row of an element. @throws FormatError
inline std::uint64_t fingerprintIn(const PlyTable& row)
{
	const auto half = [&](const char* name) {
		const double value = row.reals(name, 0)[0];
		if (value > 0xFFFFFFFFu || value != std::floor(value))
			throw row.error(0, std::string("'") + name + "' is no integer of 32 bits.");
		return std::uint64_t(value);
	};
	return half("fingerprint_low") | half("fingerprint_high") << 32;
}

} // namespace vcg::tri::mcf

#endif
