// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What a run finds and decides, in sentences for a log.

#ifndef VCG_MCF_NOTES_H
#define VCG_MCF_NOTES_H

#include <cmath>
#include <functional>
#include <locale>
#include <sstream>
#include <string>

namespace vcg::tri::mcf {

/// Receives notes, one sentence each, as they come up; may be empty.
using NoteCallback = std::function<void(const std::string&)>;

namespace detail {

/// A sentence of texts and numbers, these with `digits` significant digits, in the classic locale.
template <class... Parts>
std::string sentence(int digits, const Parts&... parts)
{
	std::ostringstream text;
	text.imbue(std::locale::classic());
	text.precision(digits);
	(text << ... << parts);
	return text.str();
}

/// A number within a sentence() that has another number of significant digits.
inline std::string number(double value, int digits)
{
	return sentence(digits, value);
}

/// A count that may be too large for an integer, to the next one.
inline std::string countText(double count)
{
	constexpr double most = 1e15;
	return count < most ? number(std::round(count), 16) : "more than 1e15";
}

/// A lower bound with three digits, rounded up: the number that one reads is within the bound.
inline std::string lowerBoundText(double bound)
{
	constexpr double halfOfLastDigit = 0.005; // of a number from 1 to 10
	return number(bound * (1 + halfOfLastDigit), 3);
}

} // namespace detail

} // namespace vcg::tri::mcf

#endif
