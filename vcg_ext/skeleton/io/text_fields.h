// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Numbers as text and back, the same in every locale, and files read line by line.

#ifndef VCG_MCF_TEXT_FIELDS_H
#define VCG_MCF_TEXT_FIELDS_H

#include "format_error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace vcg::tri::mcf {

/// The shortest text that reads back as the same double.
inline std::string numberText(double value)
{
	char text[32];
	const auto end = std::to_chars(text, text + sizeof text, value).ptr;
	return std::string(text, end);
}

/**
 * The lines of a text file as fields between blanks. Each error it throws carries the number of the
 * line last read.
 */
class FieldReader
{
public:
	explicit FieldReader(std::istream& in) : in(in) {}

	/// Reads the next line; false at the end of the file.
	bool nextLine()
	{
		if (!std::getline(in, text))
			return false;
		++number;
		fields.clear();
		const std::string_view all = text;
		constexpr std::string_view blanks = " \t\r\v\f";
		for (std::size_t from = all.find_first_not_of(blanks); from != all.npos;) {
			const std::size_t to = std::min(all.find_first_of(blanks, from), all.size());
			fields.push_back(all.substr(from, to - from));
			from = all.find_first_not_of(blanks, to);
		}
		return true;
	}

	std::size_t line() const { return number; }
	std::size_t count() const { return fields.size(); }
	std::string_view operator[](std::size_t i) const { return fields[i]; }
	bool isBlank() const { return fields.empty(); }
	bool isComment() const { return !fields.empty() && fields[0].front() == '#'; }

	FormatError error(const std::string& what) const { return FormatError::atLine(number, what); }

	/// @throws FormatError unless the line has `wanted` fields, which `form` describes.
	void expectCount(std::size_t wanted, const char* form) const
	{
		if (count() != wanted)
			throw error("expected '" + std::string(form) + "', found " + std::to_string(count())
				+ (count() == 1 ? " field." : " fields."));
	}

	/// @throws FormatError unless field i is a finite number.
	double real(std::size_t i, const char* what) const
	{
		double value = 0;
		if (parse(i, value) != std::errc())
			throw error(std::string(what) + " '" + std::string(fields[i]) + "' is no number.");
		if (!std::isfinite(value))
			throw error(std::string(what) + " '" + std::string(fields[i]) + "' is not finite.");
		return value;
	}

	/// @throws FormatError unless field i is an integer in [minimum, maximum].
	int integer(std::size_t i, int minimum, int maximum, const char* what) const
	{
		int value = 0;
		const std::errc status = parse(i, value);
		const bool isTooLarge = status == std::errc::result_out_of_range; // for any int
		if (status != std::errc() && !isTooLarge)
			throw error(std::string(what) + " '" + std::string(fields[i]) + "' is no integer.");
		if (isTooLarge || value < minimum || value > maximum)
			throw error(std::string(what) + " " + std::string(fields[i]) + " is not between "
				+ std::to_string(minimum) + " and " + std::to_string(maximum) + ".");
		return value;
	}

private:
	/// @return invalid_argument also where something follows the number.
	template <class Number>
	std::errc parse(std::size_t i, Number& value) const
	{
		std::string_view field = fields[i];
		if (field.size() > 1 && field[0] == '+' && field[1] != '-')
			field.remove_prefix(1);
		const auto [end, status] =
			std::from_chars(field.data(), field.data() + field.size(), value);
		return end == field.data() + field.size() ? status : std::errc::invalid_argument;
	}

	std::istream& in;
	std::string text;
	std::size_t number = 0;
	std::vector<std::string_view> fields;
};

} // namespace vcg::tri::mcf

#endif
