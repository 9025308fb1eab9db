// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The error of a file that does not follow its format.

#ifndef VCG_MCF_FORMAT_ERROR_H
#define VCG_MCF_FORMAT_ERROR_H

#include <skeleton/core/errors.h>

#include <cstddef>
#include <string>

namespace vcg::tri::mcf {

/// A file is malformed; the text says where and what was expected.
class FormatError : public Error
{
public:
	/// @param line from 1, in the text of the file, or in the header of a binary one.
	static FormatError atLine(std::size_t line, const std::string& what)
	{
		return FormatError("Line " + std::to_string(line) + ": " + what, line, -1);
	}

	/// @param byte offset from the start of the file; `where` names the element and row.
	static FormatError atByte(std::size_t byte, const std::string& where, const std::string& what)
	{
		return FormatError(
			"Byte " + std::to_string(byte) + " (" + where + "): " + what, 0, (long long)(byte));
	}

	/// A row of an element, from 0, is missing, or its values are wrong or contradict the file.
	static FormatError atRow(const std::string& element, std::size_t row, const std::string& what)
	{
		return FormatError(
			"Element '" + element + "', row " + std::to_string(row) + ": " + what, 0, -1);
	}

	/// The line number, from 1; 0 if the error is not in a line of text.
	std::size_t line() const { return lineNumber; }
	/// The offset in the file; -1 if the error is not at a byte.
	long long byte() const { return byteOffset; }

private:
	FormatError(const std::string& what, std::size_t line, long long byte) :
			Error(what), lineNumber(line), byteOffset(byte)
	{
	}

	std::size_t lineNumber;
	long long byteOffset;
};

} // namespace vcg::tri::mcf

#endif
