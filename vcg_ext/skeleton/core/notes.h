// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief What a run finds and decides, in sentences for a log.

#ifndef VCG_MCF_NOTES_H
#define VCG_MCF_NOTES_H

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

} // namespace detail

} // namespace vcg::tri::mcf

#endif
