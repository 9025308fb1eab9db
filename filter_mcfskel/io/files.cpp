// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <QFile>
#include <QSaveFile>

#include <istream>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

namespace mcfskel {

namespace {

FileError fileError(const char* what, const QString& name, const QFileDevice& file)
{
	return FileError(
		QString("Cannot %1 '%2': %3").arg(what, name, file.errorString()).toStdString());
}

/// A file of Qt's behind a stream of the standard's.
class FileBuffer : public std::streambuf
{
public:
	FileBuffer(QFileDevice& file, const QString& name) : file(file), name(name) {}

protected:
	int_type underflow() override
	{
		consumed += egptr() - eback();
		block.resize(size_t(1) << 20);
		const qint64 count = file.read(block.data(), qint64(block.size()));
		if (count < 0)
			throw fileError("read", name, file);
		setg(block.data(), block.data(), block.data() + count);
		return count > 0 ? traits_type::to_int_type(*gptr()) : traits_type::eof();
	}

	/// Tells how much has been read; cannot go elsewhere.
	pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override
	{
		const bool tells = offset == 0 && from == std::ios_base::cur;
		return tells ? pos_type(consumed + (gptr() - eback())) : pos_type(off_type(-1));
	}

	std::streamsize xsputn(const char* bytes, std::streamsize count) override
	{
		if (file.write(bytes, count) != count)
			throw fileError("write", name, file);
		return count;
	}

	int_type overflow(int_type c) override
	{
		const char byte = traits_type::to_char_type(c);
		return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
	}

private:
	QFileDevice& file;
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
			throw fileError("read", name, file);
		stream.exceptions(std::ios_base::badbit); // hands on what the buffer throws
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

void writeFile(const QString& name, const std::function<void(std::ostream&)>& write)
{
	QSaveFile file(name);
	// A device or a folder that takes no new files can still be written to.
	file.setDirectWriteFallback(true);
	if (!file.open(QIODevice::WriteOnly))
		throw fileError("write", name, file);
	FileBuffer buffer(file, name);
	std::ostream out(&buffer);
	out.exceptions(std::ios_base::badbit);
	write(out);
	if (!file.commit())
		throw fileError("write", name, file);
}

} // namespace mcfskel
