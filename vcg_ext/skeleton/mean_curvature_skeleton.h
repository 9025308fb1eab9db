// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: curve skeletons of VCG meshes, in one call or stage by stage.

#ifndef VCG_MCF_MEAN_CURVATURE_SKELETON_H
#define VCG_MCF_MEAN_CURVATURE_SKELETON_H

#include "skeletonize.h"
#include "trimesh.h"

#include <wrap/callback.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vcg::tri {

/**
 * Curve skeleton of a closed triangle mesh by mean curvature flow with medial attraction (Eq. 6):
 *
 * Tagliasacchi, Alhashim, Olson, Zhang, "Mean Curvature Skeletons", Computer Graphics Forum (SGP)
 * 31(5), 2012, doi 10.1111/j.1467-8659.2012.03178.x.
 *
 * All in one call:
 * \code
 * tri::MeanCurvatureSkeleton<MyMesh>::Params params;
 * MyEdgeMesh skeleton;
 * tri::MeanCurvatureSkeleton<MyMesh>::Do(mesh, skeleton, params);
 * \endcode
 *
 * or stage by stage:
 * \code
 * tri::MeanCurvatureSkeleton<MyMesh> run(mesh, params);
 * run.Resample();
 * run.ComputePoles();
 * while (run.Step())
 *     ;
 * run.Collapse();
 * run.Refine();
 * run.GetSkeleton(skeleton);
 * run.WriteNodes(mesh);
 * \endcode
 *
 * Both ways give the same result, to the last bit, except that only Do() makes a second attempt
 * where the first fails, see mcf::skeletonize(), and can join the pieces.
 *
 * MeshType is any TriMesh with vertices and triangles, in float or double; it needs no adjacency,
 * no normals, and may have deleted elements. The mesh should bound a solid: closed, two-manifold,
 * of any number of components. One that does not is repaired in a copy, as Params::repair says: see
 * mcf::solidSurface().
 *
 * Computed in double whatever the scalar type; the same bits in each run, on any number of threads.
 *
 * Functions throw mcf::InvalidInput (the mesh bounds no solid: what is wrong, how many, where),
 * mcf::InvalidParameter, mcf::SolverError and mcf::Cancelled (a callback returned false). Meshes
 * are written to last, so that an exception leaves them unchanged.
 */
template <class MESH_TYPE>
class MeanCurvatureSkeleton
{
public:
	using MeshType = MESH_TYPE;
	using ScalarType = typename MeshType::ScalarType;

	/**
	 * The parameters, under the names that the MeshLab filter Full Skeletonize and the error
	 * messages use for them. Lengths are fractions of the bounding box diagonal of each component.
	 */
	struct Params
	{
		/// `Paper`: the paper's algorithm and nothing else, whatever `pole_method`, `denoise`,
		/// `adaptive` and `refine` say, with weights in the published unit; see
		/// mcf::Parameters::apply().
		mcf::Preset preset = mcf::Preset::Default;
		/// Cover the surface with even triangles first, as in the paper; read by Do() only.
		bool resample = true;
		/// Their edge length, in [0, 0.5]; 0: chosen from the mesh. Recommended: 0.003 to 0.015.
		double target_length = 0;
		/// Rounds of the resampling, >= 0. Recommended: 3 to 10.
		int resample_iterations = 5;
		/// Measure the noise of the surface, and smooth it before the resampling.
		bool denoise = true;
		/// Lengths follow the local thickness where it is small; else they are the same everywhere.
		bool adaptive = true;
		/// With `adaptive`, the longest edge in local thicknesses, in (0, 2].
		/// Recommended: 0.4 to 1.
		double relative_length = mcf::Parameters().relativeLength;
		/// Smoothness weight w_L (Eq. 6), > 0; 1 is half the published weight unless `preset` is
		/// `Paper`. Recommended: 0.5 to 4.
		double w_l = 1;
		/// Velocity weight w_H, > 0, as published. A larger one makes smaller steps.
		/// Recommended: 10 to 50.
		double w_h = 20;
		/// Medial weight w_M, >= 0, as published. A larger one centres better and keeps more
		/// branches; 0: mean curvature flow alone. Recommended: 0 to 80.
		double w_m = 40;
		/// Edges shorter than this are collapsed, in [0, 0.1]; 0: the default, 0.002.
		double epsilon = 0;
		/// An edge whose two opposite angles are wider than this is split; degrees, in [60, 180).
		double split_angle = 110;
		/// Do() calls `on_stage` with every k-th stage of the contraction, >= 0; 0: none.
		int keep_stages = 0;
		/// Receives these stages, valid during the call, and the iterations made; these begin anew
		/// where the contraction starts over, see mcf::Observer::onStartOver.
		std::function<void(const MeshType& stage, int iteration)> on_stage;
		/// The contraction stops after this many iterations, >= 0; it usually needs 10 to 40.
		int max_iterations = 500;
		/// Shrinking balls, or the Voronoi diagram as in the paper, which needs Qhull.
		mcf::PoleMethod pole_method = mcf::PoleMethod::Balls;
		/// A mesh that does not bound a solid: `Auto` mends small defects, and wraps the surface
		/// where that is not enough; `Mend` does no more than the former; `Off` refuses it.
		mcf::Repair repair = mcf::Repair::Auto;
		/// Pieces below this fraction of the largest one's volume get no skeleton, in [0, 1).
		double min_component = 0;
		/// Do() joins the skeletons of all pieces by bridges over the narrowest gaps: nodes in
		/// their middle have 1 in the per-vertex attribute `mcfskel_bridge`. Ignored where there
		/// are sheets.
		bool join = false;
		/// Refine the curve: spurs, centring, smoothness, tips.
		bool refine = true;
		/// With `refine`, how small branches may be, in [0, 1]: those stay whose significance is at
		/// least 1 - detail. 0: the trunk alone; 1: all.
		double detail = mcf::Parameters().detail;
		/// Selected vertices of the surface stay where they are; the curve is then not refined.
		bool fix_selected = false;
		/// Flat parts become sheets, faces of the skeleton, which is then not refined.
		bool keep_sheets = false;
		/// How flat a part must be to become a sheet, in [0, 1]; 1: curves only.
		/// Recommended: 0.6 to 0.9.
		double sheet_threshold = mcf::Parameters().sheetThreshold;
		/// Receives one sentence each on what was repaired, found and decided; may be empty.
		mcf::NoteCallback on_note;
	};

	/**
	 * Computes the skeleton of a surface.
	 *
	 * @param surface  closed triangle mesh. Its geometry is unchanged; it gets the per-vertex
	 *                 attribute `mcfskel_node` (ScalarType): the vertex of `skeleton` that each
	 *                 vertex belongs to, -1 if it has no face or its piece gets no skeleton.
	 * @param skeleton any mesh with vertices and edges, and with faces if params.keep_sheets is
	 *                 set; its contents are replaced. The local thickness, the mean distance to the
	 *                 surface, is its per-vertex attribute `mcfskel_radius`, and its vertex quality
	 *                 where it has one; if the curve was refined, `mcfskel_significance` is how
	 *                 much of the shape its branch stands for, 0 to 1. VCG frees attributes in a
	 *                 mesh's ClearAttributes(), not with it.
	 * @param params   see Params.
	 * @param cb       progress callback of VCG, or null; it cancels by returning false.
	 * @throws mcf::InvalidInput, mcf::InvalidParameter, mcf::SolverError, mcf::Cancelled;
	 *         std::bad_alloc.
	 * Complexity: O(V log V), some 10 to 40 steps of the flow: about a second for 50,000 vertices.
	 */
	template <class SkeletonMesh>
	static void Do(MeshType& surface, SkeletonMesh& skeleton, const Params& params = Params(),
		vcg::CallBackPos* cb = nullptr)
	{
		RequireSkeletonMesh(skeleton, params);
		mcf::requireScalarAttribute(surface, nodeAttribute);
		const mcf::Progress progress = ProgressOf(cb);
		const mcf::Parameters parameters = ParametersOf(params);
		const Surface read(surface, params, progress.part(0, 0.02));
		mcf::Observer observer;
		observer.onNote = params.on_note;
		if (params.keep_stages > 0 && params.on_stage) {
			observer.every = params.keep_stages;
			observer.onStage = [&](const mcf::Stage& stage) {
				MeshType mesh;
				mcf::fillMesh(mesh, stage.mesh);
				params.on_stage(mesh, stage.iteration);
			};
		}
		const mcf::Skeletonization result =
			mcf::skeletonize({read.mesh, read.held, nullptr, read.hollow}, parameters,
				progress.part(0.02, 1), observer);
		FillSkeleton(skeleton, result.curve, result.sheets);
		WriteNodes(surface, read.vertexOfSlot, result.node);
	}

	/**
	 * Begins a run stage by stage: reads and checks the surface, which may be changed or deleted
	 * afterwards. The parameters and the callback apply to all stages. @throws as Do().
	 */
	explicit MeanCurvatureSkeleton(
		const MeshType& surface, const Params& params = Params(), vcg::CallBackPos* cb = nullptr) :
			params(params),
			parameters(ParametersOf(params)), progress(ProgressOf(cb)),
			input(surface, params, progress), contracted(input.mesh), held(input.held)
	{
	}

	/// Resamples the surface, with params.denoise after smoothing its noise; may be left out.
	/// @pre there are no poles yet.
	void Resample()
	{
		Require(!poles, "Resample() comes first.");
		parameters = ParametersOf(params);
		mcf::ResampledSurface resampled =
			mcf::resampledSurface(*input.mesh, parameters, progress, params.on_note);
		parameters.adaptive = parameters.adaptive && !resampled.isTooThin;
		auto mesh = std::make_shared<const mcf::SurfaceMesh>(std::move(resampled.mesh));
		if (!input.held.empty())
			held = mcf::selectionOnResampled(*input.mesh, input.held, *mesh, progress);
		contracted = std::move(mesh);
		measured.reset();
	}

	/// Finds the medial pole of each vertex of the surface. @pre Step() was not called.
	void ComputePoles()
	{
		Require(!stage, "ComputePoles() comes before Step().");
		poles = std::make_shared<const mcf::PoleSet>(
			mcf::medialPoles(Measured(), parameters.poleMethod, progress));
	}

	/**
	 * Makes one iteration of the contraction; computes the poles first if there are none yet.
	 * @return whether there is more to do: false when the flow has converged or made
	 *         max_iterations, or spreads the surface, as where large parts are inside out.
	 */
	bool Step()
	{
		Begin();
		if (IsDone())
			return false;
		stage = mcf::step(*stage, parameters, progress);
		return !IsDone();
	}

	/// Collapses the stage to curves or, if the flow keeps sheets, to curves and sheets. The stage
	/// need not have converged.
	void Collapse()
	{
		Begin();
		if (stage->hasSheets())
			return CollapseKeepingSheets();
		mcf::CutCurves cut;
		curve = parameters.tidyCurve ? mcf::collapseInside(*stage, Epsilon(), progress, &cut)
									 : mcf::collapseToCurve(*stage, Epsilon(), progress, false);
		if (params.on_note && cut.components > 0)
			params.on_note(cut.text());
		sheets.reset();
	}

	/// Collapses the stage to curves and to the sheets that it has, see mcf::sheetVertices().
	void CollapseKeepingSheets()
	{
		Begin();
		sheets = mcf::collapseWithSheets(*stage, Epsilon(), progress, params.on_note);
		curve.reset();
	}

	/// Refines the curve and, after Resample(), brings what is outside the input back inside, see
	/// mcf::bringInsideInput(). @pre the stage was collapsed without sheets; no vertices are held.
	void Refine()
	{
		Require(curve.has_value(),
			"Refine() comes after Collapse(), and is for curves without sheets.");
		Require(held.empty(), "Refine() would move the skeleton off the vertices that are held.");
		mcf::RefineParameters refinement;
		refinement.adaptive = parameters.adaptive;
		refinement.relativeLength = parameters.relativeLength;
		refinement.detail = parameters.detail;
		mcf::Refinement refined = mcf::refineChecked(*curve, Measured(), refinement, progress,
			parameters.poleMethod == mcf::PoleMethod::Balls ? poles.get() : nullptr);
		if (contracted != input.mesh)
			mcf::bringInsideInput(refined.skeleton, *contracted, *input.mesh,
				NodesOfInput(refined.skeleton.node), progress);
		curve = std::move(refined.skeleton);
		if (const std::string text = refined.report.text(); params.on_note && !text.empty())
			params.on_note(text);
	}

	/// Iterations so far, convergence, and the fractions of area and volume that are left.
	mcf::StageFigures Figures() const
	{
		return stage ? mcf::figuresOf(*stage) : mcf::StageFigures();
	}

	/// The surface that is contracted: the checked one, or the resampled one after Resample().
	void GetSurface(MeshType& mesh) const { mcf::fillMesh(mesh, *contracted); }

	/// The poles of that surface's vertices, in their order.
	/// @pre ComputePoles() or Step() was called.
	const mcf::PoleSet& Poles() const
	{
		Require(poles != nullptr, "ComputePoles() comes first.");
		return *poles;
	}

	/// The contracted surface. @pre Step() was called.
	void GetStage(MeshType& mesh) const
	{
		Require(stage.has_value(), "Step() comes first.");
		mcf::fillMesh(mesh, stage->mesh);
	}

	/// The skeleton, with its radii: see Do(). @pre Collapse() was called.
	template <class SkeletonMesh>
	void GetSkeleton(SkeletonMesh& skeleton) const
	{
		RequireCollapsed();
		RequireSkeletonMesh(skeleton, params);
		FillSkeleton(skeleton, curve ? *curve : mcf::CurveSkeleton(), sheets);
	}

	/**
	 * Writes `mcfskel_node` on the surface of the run: see Do(). @pre Collapse() was called.
	 * @throws mcf::InvalidInput if its number of vertices has changed since the run began.
	 */
	void WriteNodes(MeshType& surface) const
	{
		RequireCollapsed();
		mcf::requireScalarAttribute(surface, nodeAttribute);
		if (surface.vert.size() != input.vertexOfSlot.size())
			throw mcf::InvalidInput("The surface is not the one that the skeleton was made from.");
		const std::vector<int>& node = sheets ? sheets->skeleton.node : curve->node;
		WriteNodes(surface, input.vertexOfSlot, NodesOfInput(node));
	}

private:
	static constexpr const char* nodeAttribute = "mcfskel_node";
	static constexpr const char* radiusAttribute = "mcfskel_radius";
	static constexpr const char* significanceAttribute = "mcfskel_significance";
	static constexpr const char* bridgeAttribute = "mcfskel_bridge";

	/// A surface as the library takes it.
	struct Surface
	{
		std::shared_ptr<const mcf::SurfaceMesh> mesh;
		/// For each vertex slot of the VCG mesh the vertex of `mesh`, or -1.
		std::vector<int> vertexOfSlot;
		/// 1 for the vertices that are held; empty if there are none.
		std::vector<char> held;
		/// The surface with its cavities, see mcf::SurfaceInput::hollow; null if there are none.
		std::shared_ptr<const mcf::SurfaceMesh> hollow;

		Surface(const MeshType& surface, const Params& params, const mcf::Progress& progress)
		{
			const mcf::TriangleSoup soup = mcf::readTriangles(surface, progress.part(0, 0.1));
			mcf::SolidSurface solid = mcf::solidSurface(
				mcf::roundedCoordinates(soup.points, soup.triangles, progress.part(0.1, 0.2)),
				soup.triangles, {params.repair, params.min_component, true}, progress.part(0.2, 1));
			hollow = solid.report.leftOut.hollow;
			mcf::CheckedSurface& checked = solid.surface;
			mesh = std::make_shared<const mcf::SurfaceMesh>(std::move(checked.mesh));
			vertexOfSlot.reserve(soup.pointOfSlot.size());
			for (int point : soup.pointOfSlot)
				vertexOfSlot.push_back(point < 0 ? -1 : checked.vertexOfInput[size_t(point)]);
			if (params.on_note)
				for (const std::string& note : checked.notes)
					params.on_note(note);
			if (params.fix_selected)
				Hold(surface);
		}

		void Hold(const MeshType& surface)
		{
			held.assign(size_t(mesh->vertexSlots()), 0);
			for (size_t slot = 0; slot < vertexOfSlot.size(); ++slot)
				if (vertexOfSlot[slot] >= 0 && surface.vert[slot].IsS())
					held[size_t(vertexOfSlot[slot])] = 1;
			if (std::find(held.begin(), held.end(), 1) == held.end())
				throw mcf::InvalidInput(
					"No vertex of the mesh is selected: select the vertices to hold, "
					"or leave 'fix_selected' off.");
		}
	};

	Params params;
	mcf::Parameters parameters;
	mcf::Progress progress;
	Surface input;
	std::shared_ptr<const mcf::SurfaceMesh> contracted;
	std::shared_ptr<const mcf::MeasuredSurface> measured; ///< see Measured()
	std::vector<char> held;
	std::shared_ptr<const mcf::PoleSet> poles;
	std::optional<mcf::Stage> stage;
	std::optional<mcf::CurveSkeleton> curve;
	std::optional<mcf::SheetCollapse> sheets;

	static mcf::Progress ProgressOf(vcg::CallBackPos* cb)
	{
		return cb ? mcf::Progress(cb) : mcf::Progress();
	}

	static mcf::Parameters ParametersOf(const Params& params)
	{
		mcf::Parameters result;
		result.resample = params.resample;
		result.targetLength = params.target_length;
		result.resampleIterations = params.resample_iterations;
		result.denoise = params.denoise;
		result.adaptive = params.adaptive;
		result.relativeLength = params.relative_length;
		result.wL = params.w_l;
		result.wH = params.w_h;
		result.wM = params.w_m;
		result.epsilon = params.epsilon == 0 ? mcf::Parameters().epsilon : params.epsilon;
		result.splitAngle = params.split_angle;
		result.maxIterations = params.max_iterations;
		result.poleMethod = params.pole_method;
		result.repair = params.repair;
		result.minComponent = params.min_component;
		result.join = params.join;
		result.refine = params.refine;
		result.detail = params.detail;
		result.keepSheets = params.keep_sheets;
		result.sheetThreshold = params.sheet_threshold;
		if (params.preset != mcf::Preset::Default)
			result.apply(params.preset);
		result.check();
		if (params.keep_stages < 0)
			throw mcf::InvalidParameter("Parameter keep_stages must be at least 0.");
		return result;
	}

	double Epsilon() const { return mcf::sharedAmong(parameters, stage->diagonal).epsilon; }

	/// @throws mcf::InvalidInput with this text unless the condition holds.
	static void Require(bool holds, const char* text)
	{
		if (!holds)
			throw mcf::InvalidInput(text);
	}

	/// For each vertex of the input its node. @param node of each vertex of the contracted surface.
	std::vector<int> NodesOfInput(const std::vector<int>& node) const
	{
		return contracted == input.mesh
			? node
			: mcf::transferredNodes(*contracted, node, *input.mesh, progress);
	}

	void RequireCollapsed() const { Require(curve || sheets, "Collapse() comes first."); }

	template <class SkeletonMesh>
	static void RequireSkeletonMesh(const SkeletonMesh& skeleton, const Params& params)
	{
		Require(SkeletonMesh::EdgeType::HasEVAdjacency(), "The skeleton needs a mesh with edges.");
		Require(!params.keep_sheets || SkeletonMesh::FaceType::HasFVAdjacency(),
			"A skeleton with sheets needs a mesh with edges and faces.");
		for (const char* name : {radiusAttribute, significanceAttribute, bridgeAttribute})
			mcf::requireScalarAttribute(skeleton, name);
	}

	/// Makes stage 0, if there is no stage yet.
	void Begin()
	{
		if (stage)
			return;
		if (!poles)
			ComputePoles();
		stage = mcf::startOfFlow(Measured(), *poles, held, parameters, progress, params.on_note);
	}

	bool IsDone() const { return mcf::isOver(*stage, parameters); }

	/// The contracted surface with what all stages ask about it; computed by the first of them.
	const mcf::MeasuredSurface& Measured()
	{
		if (!measured)
			measured = std::make_shared<const mcf::MeasuredSurface>(*contracted, progress);
		return *measured;
	}

	template <class SkeletonMesh>
	static void FillSkeleton(SkeletonMesh& skeleton, const mcf::CurveSkeleton& curve,
		const std::optional<mcf::SheetCollapse>& sheets)
	{
		if (sheets)
			mcf::fillMesh(skeleton, sheets->skeleton.position, sheets->skeleton.edges,
				mcf::orientedFaces(sheets->skeleton));
		else
			mcf::fillMesh(skeleton, curve.position, curve.edges, {});
		const std::vector<double>& radius = sheets ? sheets->skeleton.radius : curve.radius;
		mcf::writeScalarAttribute(
			skeleton, radiusAttribute, [&](size_t slot) { return radius[slot]; });
		const auto writeIfKnown = [&](const char* name, const auto& values) {
			if (!sheets && !values.empty())
				mcf::writeScalarAttribute(
					skeleton, name, [&](size_t slot) { return double(values[slot]); });
			else if (tri::HasPerVertexAttribute(skeleton, name)) // of an earlier skeleton
				tri::Allocator<SkeletonMesh>::DeletePerVertexAttribute(skeleton, name);
		};
		writeIfKnown(significanceAttribute, curve.significance);
		writeIfKnown(bridgeAttribute, curve.bridge);
		if (tri::HasPerVertexQuality(skeleton))
			for (size_t v = 0; v < radius.size(); ++v)
				skeleton.vert[v].Q() = typename SkeletonMesh::VertexType::QualityType(radius[v]);
	}

	static void WriteNodes(
		MeshType& surface, const std::vector<int>& vertexOfSlot, const std::vector<int>& node)
	{
		mcf::writeScalarAttribute(surface, nodeAttribute, [&](size_t slot) {
			return vertexOfSlot[slot] < 0 ? -1 : node[size_t(vertexOfSlot[slot])];
		});
	}
};

} // namespace vcg::tri

#endif
