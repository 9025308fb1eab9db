// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <QFile>

#include <istream>
#include <streambuf>
#include <string>
#include <vector>

namespace mcfskel {

namespace {

FileError readingError(const QString& name, const QFile& file)
{
	return FileError(QString("Cannot read '%1': %2").arg(name, file.errorString()).toStdString());
}

/// The buffer of a std::istream that reads a QFile.
class FileBuffer : public std::streambuf
{
public:
	FileBuffer(QFile& file, const QString& name) : file(file), name(name) {}

protected:
	int_type underflow() override
	{
		consumed += egptr() - eback();
		block.resize(size_t(1) << 20);
		const qint64 count = file.read(block.data(), qint64(block.size()));
		if (count < 0)
			throw readingError(name, file);
		setg(block.data(), block.data(), block.data() + count);
		return count > 0 ? traits_type::to_int_type(*gptr()) : traits_type::eof();
	}

	/// Supports tellg(), but no other position.
	pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override
	{
		const bool tells = offset == 0 && from == std::ios_base::cur;
		return tells ? pos_type(consumed + (gptr() - eback())) : pos_type(off_type(-1));
	}

private:
	QFile& file;
	QString name;
	std::vector<char> block;
	off_type consumed = 0; ///< before the block
};

} // namespace

QString requiredName(const QString& name, const char* purpose)
{
	if (name.isEmpty())
		throw vcg::tri::mcf::InvalidParameter(
			std::string("Parameter file must name the file ") + purpose + ".");
	return name;
}

struct InputFile::Opened
{
	QFile file;
	FileBuffer buffer;
	std::istream stream;

	explicit Opened(const QString& name) : file(name), buffer(file, name), stream(&buffer)
	{
		if (!file.open(QIODevice::ReadOnly))
			throw readingError(name, file);
		stream.exceptions(std::ios_base::badbit); // rethrows what the buffer throws
	}
};

InputFile::InputFile(const QString& name) : opened(std::make_unique<Opened>(name))
{
}

InputFile::~InputFile() = default;

std::istream& InputFile::stream()
{
	return opened->stream;
}

} // namespace mcfskel
