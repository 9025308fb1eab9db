// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The exceptions of the skeleton pipeline. It throws no others but std::bad_alloc.

#ifndef VCG_MCF_ERRORS_H
#define VCG_MCF_ERRORS_H

#include <stdexcept>
#include <string>

namespace vcg::tri::mcf {

/// Base of every error of the pipeline.
class Error : public std::runtime_error
{
public:
	using std::runtime_error::runtime_error;
};

/// What keeps a mesh from being the boundary of a solid, for callers that know which tool cures it.
enum class Defect {
	Other,
	Empty,               ///< no vertices
	NoFaces,             ///< vertices only
	NotFinite,           ///< coordinates that are NaN or infinite
	NonManifoldEdges,    ///< with more than two faces; there may be border edges, too
	NonManifoldVertices, ///< where separate fans of faces touch
	OneSided,            ///< not orientable; there may be border edges, too
	BorderEdges,         ///< not watertight
	NoVolume,            ///< a connected component is flat
	Flat,                ///< the whole mesh is flat
	OpenSheet            ///< bounds nothing, however its borders are closed
};

/// The mesh cannot be skeletonized; the text says what is wrong, how often, where, and the cure.
class InvalidInput : public Error
{
public:
	explicit InvalidInput(const std::string& text, Defect defect = Defect::Other) :
			Error(text), kind(defect)
	{
	}

	Defect defect() const { return kind; }

private:
	Defect kind;
};

/// A parameter is out of its range; the text names it and the range.
class InvalidParameter : public Error
{
public:
	using Error::Error;
};

/// @throws InvalidParameter "Parameter NAME must be RANGE." unless `holds`.
inline void requireParameter(bool holds, const char* name, const char* range)
{
	if (!holds)
		throw InvalidParameter(std::string("Parameter ") + name + " must be " + range + ".");
}

/// A linear system could not be solved, or a position stopped being finite.
class SolverError : public Error
{
public:
	using Error::Error;
};

/// The progress callback asked to stop.
class Cancelled : public Error
{
public:
	Cancelled() : Error("Cancelled.") {}
};

} // namespace vcg::tri::mcf

#endif
