// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * @file
 * @brief Tables of numbers in binary PLY, exact to the last bit.
 *
 * VCG's own PLY exporter serves a mesh; here are several tables (elements) of any columns, written
 * in double and read back with every count checked.
 */

#ifndef VCG_MCF_BINARY_PLY_H
#define VCG_MCF_BINARY_PLY_H

#include "format_error.h"
#include "text_fields.h"

#include <skeleton/core/progress.h>
#include <skeleton/core/ticker.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <istream>
#include <limits>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri::mcf {

/// The types of PLY, in the order of `plyTypes`.
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float, Double };

/// A property of an element: one number in each row, or a list of always the same length.
struct PlyColumn
{
	std::string name;
	PlyType type = PlyType::Double;
	/// Numbers in each row; 0: a single one, not a list.
	size_t listLength = 0;
	/// Row after row. Every type of PLY fits into a double.
	std::vector<double> values;
};

/// A table.
struct PlyElement
{
	std::string name;
	size_t rows = 0;
	std::vector<PlyColumn> columns;

	/// Adds a column. @pre it has `rows` values
	template <class Values>
	void add(const std::string& columnName, PlyType type, const Values& values)
	{
		columns.push_back({columnName, type, 0, {values.begin(), values.end()}});
	}

	const PlyColumn* find(const std::string& columnName) const
	{
		for (const PlyColumn& column : columns)
			if (column.name == columnName)
				return &column;
		return nullptr;
	}
};

struct PlyFile
{
	std::vector<std::string> comments;
	std::vector<PlyElement> elements;

	const PlyElement* find(const std::string& name) const
	{
		for (const PlyElement& element : elements)
			if (element.name == name)
				return &element;
		return nullptr;
	}
};

namespace detail {

struct PlyTypeInfo
{
	const char* name;
	const char* otherName;
	size_t bytes;
};

inline constexpr std::array<PlyTypeInfo, 8> plyTypes = {{{"char", "int8", 1}, {"uchar", "uint8", 1},
	{"short", "int16", 2}, {"ushort", "uint16", 2}, {"int", "int32", 4}, {"uint", "uint32", 4},
	{"float", "float32", 4}, {"double", "float64", 8}}};

inline const PlyTypeInfo& infoOf(PlyType type)
{
	return plyTypes[size_t(type)];
}

template <class To, class From>
To bitsAs(From from)
{
	static_assert(sizeof(To) == sizeof(From));
	To to;
	std::memcpy(&to, &from, sizeof to);
	return to;
}

/// Appends a number, lowest byte first whatever the machine's own order is.
inline void appendNumber(std::string& bytes, PlyType type, double value)
{
	std::uint64_t bits;
	if (type == PlyType::Double)
		bits = bitsAs<std::uint64_t>(value);
	else if (type == PlyType::Float)
		bits = bitsAs<std::uint32_t>(float(value));
	else
		bits = std::uint64_t(std::int64_t(value));
	for (size_t i = 0; i < infoOf(type).bytes; ++i)
		bytes.push_back(char(bits >> (8 * i) & 0xFF));
}

inline double numberAt(const char* bytes, PlyType type)
{
	std::uint64_t bits = 0;
	for (size_t i = 0; i < infoOf(type).bytes; ++i)
		bits |= std::uint64_t(static_cast<unsigned char>(bytes[i])) << (8 * i);
	switch (type) {
	case PlyType::Int8: return std::int8_t(bits);
	case PlyType::UInt8: return std::uint8_t(bits);
	case PlyType::Int16: return std::int16_t(bits);
	case PlyType::UInt16: return std::uint16_t(bits);
	case PlyType::Int32: return std::int32_t(bits);
	case PlyType::UInt32: return std::uint32_t(bits);
	case PlyType::Float: return bitsAs<float>(std::uint32_t(bits));
	case PlyType::Double: break;
	}
	return bitsAs<double>(bits);
}

} // namespace detail

/// Writes tables as binary little endian PLY.
/// @pre every column has its element's number of rows. @throws Cancelled
inline void writeBinaryPly(
	std::ostream& out, const PlyFile& file, const Progress& progress = Progress())
{
	constexpr size_t pieceSize = size_t(1) << 20;
	const char* const what = "Writing the file";
	std::string bytes = "ply\nformat binary_little_endian 1.0\n";
	for (const std::string& comment : file.comments)
		bytes += "comment " + comment + "\n";
	for (const PlyElement& element : file.elements) {
		bytes += "element " + element.name + " " + std::to_string(element.rows) + "\n";
		for (const PlyColumn& column : element.columns)
			bytes += std::string("property ") + (column.listLength ? "list uchar " : "")
				+ detail::infoOf(column.type).name + " " + column.name + "\n";
	}
	bytes += "end_header\n";
	const auto flush = [&] {
		out.write(bytes.data(), std::streamsize(bytes.size()));
		bytes.clear();
	};
	for (size_t e = 0; e < file.elements.size(); ++e) {
		const PlyElement& element = file.elements[e];
		const double count = double(file.elements.size());
		const Progress part = progress.part(double(e) / count, double(e + 1) / count);
		detail::reportedLoop(int(element.rows), part, what, [&](int r) {
			const size_t row = size_t(r);
			for (const PlyColumn& column : element.columns) {
				if (!column.listLength) {
					detail::appendNumber(bytes, column.type, column.values[row]);
					continue;
				}
				detail::appendNumber(bytes, PlyType::UInt8, double(column.listLength));
				for (size_t i = 0; i < column.listLength; ++i)
					detail::appendNumber(
						bytes, column.type, column.values[row * column.listLength + i]);
			}
			if (bytes.size() > pieceSize)
				flush();
		});
	}
	flush();
}

namespace detail {

/// The header while it is read.
struct PlyHeader
{
	PlyFile file;
	/// For each element the type of the count that precedes each list of a column.
	std::vector<std::vector<PlyType>> countTypes;
	/// The names so far: those of elements, and those of columns with the number of their element.
	std::set<std::string> elementNames;
	std::set<std::pair<size_t, std::string>> columnNames;
};

inline PlyType plyTypeOf(const FieldReader& in, size_t i)
{
	for (size_t t = 0; t < plyTypes.size(); ++t)
		if (in[i] == plyTypes[t].name || in[i] == plyTypes[t].otherName)
			return PlyType(t);
	throw in.error("'" + std::string(in[i]) + "' is no type of PLY.");
}

inline void readPlyProperty(const FieldReader& in, PlyHeader& header)
{
	if (header.file.elements.empty())
		throw in.error("a property before the first element.");
	const bool isList = in.count() > 1 && in[1] == "list";
	in.expectCount(isList ? 5 : 3, isList ? "property list TYPE TYPE NAME" : "property TYPE NAME");
	PlyElement& element = header.file.elements.back();
	PlyColumn column;
	column.name = std::string(in[in.count() - 1]);
	column.type = plyTypeOf(in, in.count() - 2);
	// The length of a list is known with its first row.
	column.listLength = isList;
	const PlyType countType = isList ? plyTypeOf(in, 2) : PlyType::UInt8;
	if (countType == PlyType::Float || countType == PlyType::Double)
		throw in.error("the length of a list is no integer.");
	if (!header.columnNames.emplace(header.file.elements.size(), column.name).second)
		throw in.error("property '" + column.name + "' is given twice.");
	element.columns.push_back(std::move(column));
	header.countTypes.back().push_back(countType);
}

inline PlyHeader readPlyHeader(std::istream& stream)
{
	FieldReader in(stream);
	if (!in.nextLine() || in.count() != 1 || in[0] != "ply")
		throw FormatError::atLine(1, "expected 'ply': this is no PLY file.");
	PlyHeader header;
	bool hasFormat = false;
	while (in.nextLine()) {
		if (in.isBlank())
			throw in.error("a blank line in the header.");
		if (in[0] == "end_header") {
			if (!hasFormat)
				throw in.error("the header names no format.");
			return header;
		}
		if (in[0] == "comment") {
			std::string comment;
			for (size_t i = 1; i < in.count(); ++i)
				comment += (i > 1 ? " " : "") + std::string(in[i]);
			header.file.comments.push_back(comment);
		}
		else if (in[0] == "format") {
			in.expectCount(3, "format binary_little_endian 1.0");
			if (in[1] != "binary_little_endian" || in[2] != "1.0")
				throw in.error("format '" + std::string(in[1]) + " " + std::string(in[2])
					+ "' is not read, only 'binary_little_endian 1.0'.");
			hasFormat = true;
		}
		else if (in[0] == "element") {
			in.expectCount(3, "element NAME COUNT");
			if (!header.elementNames.emplace(in[1]).second)
				throw in.error("element '" + std::string(in[1]) + "' is given twice.");
			PlyElement element;
			element.name = std::string(in[1]);
			element.rows = size_t(in.integer(2, 0, std::numeric_limits<int>::max(), "count"));
			header.file.elements.push_back(std::move(element));
			header.countTypes.emplace_back();
		}
		else if (in[0] == "property")
			readPlyProperty(in, header);
		else if (in[0] != "obj_info")
			throw in.error("'" + std::string(in[0]) + "' is no word of a PLY header.");
	}
	throw FormatError::atLine(in.line() + 1, "the file ends within the header.");
}

} // namespace detail

/**
 * Reads binary little endian PLY whose lists have one length throughout a column.
 * @throws FormatError with the line (header) or the byte (data): anything malformed, a file that
 *         ends too early, bytes after the end; Cancelled.
 * Memory is taken as data arrive, so that a wrong count cannot exhaust it.
 */
inline PlyFile readBinaryPly(std::istream& stream, const Progress& progress = Progress())
{
	const char* const what = "Reading the file";
	detail::PlyHeader header = detail::readPlyHeader(stream);
	const std::streamoff start = std::max<std::streamoff>(0, stream.tellg());
	std::string data;
	std::vector<char> piece(size_t(1) << 20);
	do {
		progress.report(0, what);
		stream.read(piece.data(), std::streamsize(piece.size()));
		data.append(piece.data(), size_t(stream.gcount()));
	} while (stream);
	double rows = 0;
	for (const PlyElement& element : header.file.elements)
		rows += double(element.rows);
	detail::Ticker ticker(progress, what, rows);
	size_t at = 0;
	for (size_t e = 0; e < header.file.elements.size(); ++e) {
		PlyElement& element = header.file.elements[e];
		if (element.columns.empty() && element.rows > 0)
			throw FormatError::atRow(element.name, 0, "the element has rows but no properties.");
		for (size_t row = 0; row < element.rows; ++row) {
			ticker.tick();
			const auto fail = [&](const std::string& what) {
				return FormatError::atByte(size_t(start) + at,
					"element '" + element.name + "', row " + std::to_string(row) + " of "
						+ std::to_string(element.rows),
					what);
			};
			const auto take = [&](PlyType type) {
				const size_t bytes = detail::infoOf(type).bytes;
				if (data.size() - at < bytes)
					throw fail("the file ends here.");
				at += bytes;
				return detail::numberAt(data.data() + at - bytes, type);
			};
			for (size_t c = 0; c < element.columns.size(); ++c) {
				PlyColumn& column = element.columns[c];
				if (!column.listLength) {
					column.values.push_back(take(column.type));
					continue;
				}
				const double length = take(header.countTypes[e][c]);
				if (row == 0 && length >= 1 && length <= 255)
					column.listLength = size_t(length);
				if (length != double(column.listLength))
					throw fail("a list of " + numberText(length) + " numbers in '" + column.name
						+ "', where " + std::to_string(column.listLength) + " were expected.");
				for (size_t i = 0; i < column.listLength; ++i)
					column.values.push_back(take(column.type));
			}
		}
	}
	if (at < data.size())
		throw FormatError::atByte(size_t(start) + at, "after the last element",
			std::to_string(data.size() - at) + " bytes too many.");
	return std::move(header.file);
}

} // namespace vcg::tri::mcf

#endif
