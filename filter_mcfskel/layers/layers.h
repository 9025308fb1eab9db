// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Between the host's layers and the pipeline: reading surfaces and stages from layers,
/// writing results as new layers and as custom attributes.
///
/// What users and scripts see are the attributes mcfskel_*. They hold the host's scalar, often a
/// float, while the pipeline computes in double. So each layer also carries its exact state, in one
/// more attribute (attributes.h), and steps made one by one equal a full run, bit for bit.
/// Positions and attributes that are edited later replace those of the state; if the triangles or
/// edges change, the state is lost.

#ifndef MCFSKEL_LAYERS_H
#define MCFSKEL_LAYERS_H

#include "../host/host_api.h"
#include "layer_as_read.h"
#include "stage_fields.h"

#include <skeleton/solid.h>
#include <skeleton/state.h>

#include <QString>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace mcfskel {

/// A surface layer as the pipeline takes it: checked, compact, in double.
struct SurfaceLayer
{
	std::shared_ptr<const vcg::tri::mcf::SurfaceMesh> mesh;
	/// For each vertex slot of the layer, deleted ones included, the vertex of `mesh`, or -1.
	std::shared_ptr<const std::vector<int>> vertexOfSlot;
	/// What had to be repaired, for the log.
	std::vector<std::string> notes;
	/// For each connected component whether it was inside out; empty if all or none of them were.
	std::vector<char> turned = {};
	/// The surface with the cavities that `mesh` lacks, see LeftOutPieces::hollow; null if none.
	std::shared_ptr<const vcg::tri::mcf::SurfaceMesh> hollow = nullptr;
	/// The repair that has nothing left to do on it, cavities included, as it has made or checked
	/// this surface or the one that it was resampled from. Off: nothing is known.
	vcg::tri::mcf::Repair soundWith = vcg::tri::mcf::Repair::Off;
};

/// Which layer a stage or skeleton comes from.
struct SurfaceLink
{
	int layerId = -1;
	/// Of the layer's geometry, so that another layer is never taken for it.
	std::uint64_t fingerprint = 0;
	std::shared_ptr<const std::vector<int>> vertexOfSlot;
};

/// A stage of the contraction as found on a layer.
struct StageLayer
{
	std::shared_ptr<const vcg::tri::mcf::Stage> stage;
	SurfaceLink surface;

	explicit operator bool() const { return stage != nullptr; }
};

/// A skeleton as found on a layer.
struct CurveLayer
{
	/// Exact if the layer is still what a filter made; else what the layer shows, with radius and
	/// significance from their attributes or empty. `node` is empty if it is not known.
	vcg::tri::mcf::CurveSkeleton skeleton;
	/// The surface whose vertices `skeleton.node` counts.
	SurfaceLink surface;
	QString surfaceName;

	/// For each vertex of the surface's layer its node or -1; empty if not known.
	std::vector<int> nodeOfLayerVertex() const;
};

/**
 * The length, in mesh units, that 100 % of a Length means on this layer: the bounding box diagonal,
 * 0 if it is not finite; of a stage, or of a skeleton that a filter made, that of its surface, so
 * that it is the same at every step.
 */
double referenceDiagonal(const MeshModel& layer);

/// A name without copy number, file type and what the filters append: NAME of NAME_meso_4(1);
/// "mesh" if nothing is left.
QString baseName(QString name);

/// The same for the layer's name.
QString baseName(const MeshModel& layer);

/// Whether a layer has a name that a filter gives, such as NAME_meso_4(1). NAME(1) is none: hosts
/// number layers of one name.
bool hasMadeName(const MeshModel& layer);

/**
 * Reads and checks a surface layer; the layer itself is not changed.
 * @throws InvalidInput if it is empty, has no faces, is a stage of the contraction, is not a closed
 *         two-manifold (see checkedSurface()), or has an attribute mcfskel_* of a foreign type;
 *         Cancelled.
 */
SurfaceLayer readSurface(
	const MeshModel& layer, const vcg::tri::mcf::Progress& progress = vcg::tri::mcf::Progress());

/// A surface layer made into that of a solid, which may have other vertices.
struct SolidLayer
{
	/// `vertexOfSlot` names the closest vertex where the layer's own is not one of the solid's.
	SurfaceLayer surface;
	vcg::tri::mcf::SolidReport report;

	/// Whether it is another surface than the layer's.
	bool isRepaired() const { return report.isChanged(); }
};

/**
 * As readSurface(), with what does not bound a solid repaired: see solidSurface(). The surface in
 * the layer's state is taken where that would leave it as it is.
 * @throws InvalidInput as readSurface(), for what `choices` do not repair; SolverError, Cancelled.
 */
SolidLayer readSolid(const MeshModel& layer, const vcg::tri::mcf::SolidChoices& choices,
	const vcg::tri::mcf::Progress& progress = vcg::tri::mcf::Progress());

/**
 * The selected vertices of a layer.
 * @param vertexOfSlot  for each vertex slot of the layer the vertex that it is, or -1.
 * @return 1 for the selected ones of `vertices` vertices; empty if none is selected.
 */
std::vector<char> readSelection(
	const MeshModel& layer, const std::vector<int>& vertexOfSlot, int vertices);

/// As above for a layer whose slots are its vertices, as those of a stage are.
std::vector<char> readSelection(const MeshModel& layer);

/// Where the state of a layer is looked for if the layer has none, and the log that says so.
struct StateSources
{
	const MeshDocument& document;
	/// Receives lines for the log.
	std::function<void(const QString&)> note;
};

/**
 * The stage that a layer holds, with later edits of positions, poles, fixed and held marks; empty
 * if it is none, or if its triangles were changed. Copies of layers and a filter's files count.
 * @throws InvalidStage if the edits make no valid stage; InvalidInput if the layer has an attribute
 *         mcfskel_* of a foreign type.
 */
StageLayer readStage(const MeshModel& layer, const StateSources& sources);

/// Why readStage() finds no stage on a layer that seems to have been one; empty for other layers.
QString lostState(const MeshModel& layer);

/**
 * Reads a skeleton from a layer of edges, of any origin. A single node without edges counts if a
 * filter made it. Edges without a vertex at an end are left out: see hasVertices().
 * @throws InvalidInput if the layer has faces, no edges, an edge from a vertex to itself, or nodes
 *         that isUsablePlace() refuses.
 */
CurveLayer readCurve(const MeshModel& layer);

/// As above, but finds skeletons as readStage() finds stages: with edits, in copies and in files.
CurveLayer readCurve(const MeshModel& layer, const StateSources& sources);

/// The surface that the skeleton on a layer remembers, wherever its nodes are by now; a link to no
/// layer if there is none.
SurfaceLink surfaceOfCurve(const MeshModel& layer);

/// Puts a skeleton into a new, empty layer.
void fillCurve(MeshModel& layer, const CurveLayer& curve);

/// The values of mcfskel_node on a surface layer, for each vertex not deleted; empty if none.
std::vector<int> readNodes(const MeshModel& layer);

/**
 * The poles that a surface layer carries, one for each vertex of `surface`; null if it has none, or
 * none that fit its vertices. Exact ones unless somebody has changed the visible ones.
 * @throws Cancelled
 */
std::shared_ptr<const vcg::tri::mcf::PoleSet> readPoles(
	const MeshModel& layer, const SurfaceLayer& surface, const vcg::tri::mcf::Progress& progress);

/**
 * Changes to a document, all or none. Until commit() only layers and attributes are added, and they
 * are removed again if it is not reached; existing values change in commit() alone.
 * @pre existing layers that are written on have gone through readSurface() or readStage(), and have
 *      as many vertices as then: see LayerAsRead.
 */
class DocumentEdit
{
public:
	explicit DocumentEdit(MeshDocument& document);
	~DocumentEdit();
	DocumentEdit(const DocumentEdit&) = delete;
	DocumentEdit& operator=(const DocumentEdit&) = delete;

	/// A new surface layer in the frame of `source`. @throws Cancelled
	MeshModel& addSurface(const MeshModel& source, const QString& label,
		const vcg::tri::mcf::SurfaceMesh& mesh, const vcg::tri::mcf::Progress& progress);

	/// A new layer of points without faces in the frame of `source`.
	MeshModel& addPoints(
		const MeshModel& source, const QString& label, const std::vector<vcg::Point3d>& points);

	/// A new layer of nodes and edges in the frame of `source`; the radius is also the quality.
	MeshModel& addCurve(const MeshModel& source, const QString& label,
		const std::vector<vcg::Point3d>& nodes, const std::vector<std::array<int, 2>>& edges,
		const std::vector<double>& radius);

	/// The same with the skeleton's whole state, correspondence included.
	MeshModel& addCurve(const MeshModel& source, const QString& label, const CurveLayer& curve);

#if MCFSKEL_SHEETS
	/// A new layer of curves and sheets, with mcfskel_kind and mcfskel_radius, which is also the
	/// quality.
	MeshModel& addMesoSkeleton(
		const MeshModel& source, const QString& label, const vcg::tri::mcf::MesoSkeleton& skeleton);
#endif

	/// A new layer of a stage, with all that the next step needs. @throws Cancelled
	MeshModel& addStage(const MeshModel& source, const QString& label,
		std::shared_ptr<const vcg::tri::mcf::Stage> stage, const StageFields& fields,
		const SurfaceLink& surface, const vcg::tri::mcf::Progress& progress);

	/// As above for what a file held: in the frame of its surface's layer, if that is there.
	/// @param diagonal what 100 % of a Length is on the layer; 0: not known.
	MeshModel& addCurve(const QString& label, const CurveLayer& curve, double diagonal);
	MeshModel& addStage(const QString& label, std::shared_ptr<const vcg::tri::mcf::Stage> stage,
		const StageFields& fields, const SurfaceLink& surface,
		const vcg::tri::mcf::Progress& progress);

	/// Gives a layer its surface in full precision.
	void attachSurface(MeshModel& layer, const SurfaceLayer& surface);

	/// Writes poles as attributes of a surface layer, and gives it its surface in full precision.
	void writePoles(MeshModel& layer, const SurfaceLayer& surface,
		std::shared_ptr<const vcg::tri::mcf::PoleSet> poles);

	/// Writes mcfskel_node: for each vertex of the layer's surface the vertex it has merged into.
	void writeNodes(
		MeshModel& layer, const std::vector<int>& vertexOfSlot, const std::vector<int>& node);

	/// As above for a surface known by its link, if that layer is still there and unchanged.
	void writeNodes(const SurfaceLink& surface, const std::vector<int>& node);

	/**
	 * Keeps the changes and makes the layer added last the current one. To be called last in a
	 * filter, after all that can fail, such as allocating its results. In MeshLab's window the
	 * layer added last lies inside those that it was made from. To make it visible these are
	 * hidden, and so are the other new ones and what was made from the same surface before; curves
	 * and points are coloured by their quality, not shaded, within the outline of their surface.
	 * Without a window nothing of this is done: scripts use visibility to say which layers a filter
	 * works on, and colours would be saved with the layer.
	 * @throws InvalidInput if a layer that is written on was deleted or changed meanwhile; nothing
	 *         is changed then.
	 */
	void commit();

private:
	/// An attribute that a layer did not have.
	struct NewAttribute
	{
		int layer;
		const char* name;
	};

	MeshModel& addLayer(const MeshModel& source, const QString& label);
	MeshModel& addLayer(const SurfaceLink& surface, const QString& label);
	MeshModel& addLayer(const Matrix44m& frame, const QString& label);
	/// To be called before an attribute is made.
	void noteNew(MeshModel& layer, const char* attribute);
	void changeState(MeshModel& layer, const SurfaceLayer& surface,
		std::shared_ptr<const vcg::tri::mcf::PoleSet> poles);
	void present();
	/// The surface to outline around the layer added last; null if there is none. Around a skeleton
	/// made from another one it counts only while it is visible: the user may have hidden it.
	const MeshModel* surfaceToOutline() const;

	MeshDocument& document;
	int previousLayer;
	std::vector<int> added;
	std::vector<NewAttribute> newAttributes;
	/// The layers that `changes` write on.
	std::vector<LayerAsRead> written;
	/// What commit() does to existing layers. It cannot fail: all memory is allocated before.
	std::vector<std::function<void()>> changes;
	/// The layers that the added ones were made from.
	std::vector<int> sources;
	bool committed = false;
};

/// The layer that a link leads to: that of its id if unchanged, else one of its geometry; or null.
MeshModel* layerOf(MeshDocument& document, const SurfaceLink& link);

/// The link to a surface layer, for the stages that will come from it.
SurfaceLink linkTo(const MeshModel& layer, const SurfaceLayer& surface);

/// The link to the layer of a document that has this fingerprint, if there is one.
SurfaceLink linkTo(
	const MeshDocument& document, std::uint64_t fingerprint, std::vector<int> vertexOfSlot);

} // namespace mcfskel

#endif
