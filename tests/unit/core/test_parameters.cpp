// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "shapes.h"

#include <skeleton/core/parameters.h>
#include <skeleton/flow/flow.h>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

using namespace vcg::tri::mcf;
using vcg::Point3d;

namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The text with which the changed parameters are refused; empty if they are taken.
std::string refusal(const std::function<void(Parameters&)>& change)
{
	Parameters parameters;
	change(parameters);
	try {
		parameters.check();
	}
	catch (const InvalidParameter& error) {
		return error.what();
	}
	return "";
}

} // namespace

TEST(Parameters, DefaultsAreThePapersAndAreTaken)
{
	const Parameters p;
	EXPECT_NO_THROW(p.check());
	EXPECT_EQ(p.wL, 1);
	EXPECT_EQ(p.wH, 20);
	EXPECT_EQ(p.wM, 40);
	EXPECT_EQ(p.epsilon, 0.002);
	EXPECT_EQ(p.splitAngle, 110);
	EXPECT_FALSE(p.keepSheets);
	EXPECT_EQ(p.maxIterations, 500);
	EXPECT_TRUE(p.resample);
	EXPECT_EQ(p.resampleIterations, 5);
}

TEST(Parameters, NamesTheOneThatIsOutOfItsRange)
{
	for (double bad : {0.0, -1.0, notANumber, infinity}) {
		EXPECT_NE(refusal([&](Parameters& p) { p.wL = bad; }).find("w_l"), std::string::npos)
			<< bad;
		EXPECT_NE(refusal([&](Parameters& p) { p.wH = bad; }).find("w_h"), std::string::npos)
			<< bad;
	}
	for (double bad : {-1.0, notANumber, infinity})
		EXPECT_NE(refusal([&](Parameters& p) { p.wM = bad; }).find("w_m"), std::string::npos)
			<< bad;
	for (double bad : {1e-7, 1e22})
		for (double Parameters::*weight :
			{&Parameters::wL, &Parameters::wH, &Parameters::cotangentFactor})
			EXPECT_NE(refusal([&](Parameters& p) {
				p.*weight = bad;
			}).find("between 0.000001 and 1000000."),
				std::string::npos)
				<< bad;
	EXPECT_EQ(refusal([](Parameters& p) { p.wM = 1e22; }),
		"Parameter w_m must be between 0 and 1000000.");
	for (double bad : {0.0, -0.1, 0.11, notANumber, infinity})
		EXPECT_NE(
			refusal([&](Parameters& p) { p.epsilon = bad; }).find("epsilon"), std::string::npos)
			<< bad;
	for (double bad : {59.9, 180.0, -110.0, notANumber, infinity})
		EXPECT_NE(refusal([&](Parameters& p) { p.splitAngle = bad; }).find("split_angle"),
			std::string::npos)
			<< bad;
	EXPECT_NE(refusal([](Parameters& p) { p.maxIterations = -1; }).find("max_iterations"),
		std::string::npos);
	for (double bad : {-0.1, 0.51, notANumber, infinity})
		EXPECT_NE(refusal([&](Parameters& p) { p.targetLength = bad; }).find("target_length"),
			std::string::npos)
			<< bad;
	EXPECT_NE(refusal([](Parameters& p) { p.resampleIterations = -1; }).find("resample_iterations"),
		std::string::npos);
}

TEST(Parameters, TakesTheEndsOfTheRanges)
{
	EXPECT_EQ(refusal([](Parameters& p) { p.wM = 0; }), "");
	EXPECT_EQ(refusal([](Parameters& p) { p.epsilon = 0.1; }), "");
	for (double bad : {-0.1, 1.1, std::nan("")})
		EXPECT_NE(refusal([&](Parameters& p) { p.sheetThreshold = bad; }).find("sheet_threshold"),
			std::string::npos);
	EXPECT_EQ(refusal([](Parameters& p) { p.splitAngle = 60; }), "");
	EXPECT_EQ(refusal([](Parameters& p) { p.splitAngle = 179.9; }), "");
	EXPECT_EQ(refusal([](Parameters& p) { p.maxIterations = 0; }), "");
	EXPECT_EQ(refusal([](Parameters& p) { p.targetLength = 0.5; }), "");
	EXPECT_EQ(refusal([](Parameters& p) { p.resampleIterations = 0; }), "");
}

TEST(Parameters, AreCheckedBeforeAnythingIsDone)
{
	const SurfaceMesh mesh = shapes::octahedron().mesh();
	PoleSet poles;
	poles.centre.assign(6, Point3d(0, 0, 0));
	poles.radius.assign(6, 1);
	Parameters parameters;
	parameters.wL = -1;
	EXPECT_THROW(step(initialStage(mesh, poles), parameters), InvalidParameter);
}

TEST(Parameters, ThePapersPresetLeavesTheShapesParametersAlone)
{
	Parameters parameters;
	parameters.wL = 1.5;
	parameters.epsilon = 0.003;
	parameters.targetLength = 0.01;
	parameters.repair = Repair::Off;
	parameters.maxIterations = 7;
	parameters.apply(Preset::Paper);
	EXPECT_EQ(parameters.wL, 1.5);
	EXPECT_EQ(parameters.epsilon, 0.003);
	EXPECT_EQ(parameters.targetLength, 0.01);
	EXPECT_EQ(parameters.repair, Repair::Off);
	EXPECT_EQ(parameters.maxIterations, 7);
	EXPECT_EQ(parameters.poleMethod, PoleMethod::Voronoi);
	EXPECT_FALSE(parameters.denoise || parameters.adaptive || parameters.coarsen
		|| parameters.refine || parameters.tidyCurve || parameters.dropOutwardPoles);
	EXPECT_TRUE(parameters.directSolver);
}

TEST(Parameters, TheDefaultPresetIsWhatTheyAreAnyway)
{
	Parameters parameters;
	parameters.apply(Preset::Paper);
	parameters.apply(Preset::Default);
	const Parameters p;
	EXPECT_EQ(parameters.poleMethod, p.poleMethod);
	EXPECT_EQ(parameters.cotangentFactor, p.cotangentFactor);
	EXPECT_EQ(parameters.directSolver, p.directSolver);
	EXPECT_TRUE(
		p.denoise && p.adaptive && p.coarsen && p.refine && p.tidyCurve && p.dropOutwardPoles);
	EXPECT_TRUE(parameters.denoise && parameters.adaptive && parameters.coarsen && parameters.refine
		&& parameters.tidyCurve && parameters.dropOutwardPoles);
	EXPECT_NE(refusal([](Parameters& changed) { changed.cotangentFactor = 0; }), "");
}
