// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <skeleton/core/errors.h>
#include <skeleton/core/progress.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace vcg::tri::mcf;

namespace {

/// A progress that writes down its percentages.
Progress recorder(std::vector<int>& percents)
{
	return Progress([&](int percent, const char*) {
		percents.push_back(percent);
		return true;
	});
}

} // namespace

TEST(Progress, ReportsFractionsAsPercents)
{
	std::vector<int> percents;
	const Progress progress = recorder(percents);
	for (double fraction : {0.0, 0.25, 0.5, 1.0})
		progress.report(fraction, "work");
	EXPECT_EQ(percents, std::vector<int>({0, 25, 50, 100}));
}

TEST(Progress, APartIsAWindow)
{
	std::vector<int> percents;
	const Progress half = recorder(percents).part(0.5, 1);
	half.report(0, "work");
	half.report(1, "work");
	const Progress nested = half.part(0.5, 0.75); // 0.75 to 0.875 of the whole
	nested.report(0, "work");
	nested.report(1, "work");
	EXPECT_EQ(percents, std::vector<int>({50, 100, 75, 87}));
}

TEST(Progress, StaysInItsWindow)
{
	std::vector<int> percents;
	const Progress window = recorder(percents).part(0.25, 0.5);
	window.report(-3, "work");
	window.report(7, "work");
	EXPECT_EQ(percents, std::vector<int>({25, 50}));
}

TEST(Progress, PassesOnWhatIsBeingDone)
{
	std::string said;
	const Progress progress([&](int, const char* what) {
		said = what;
		return true;
	});
	progress.part(0, 0.5).report(0.5, "Contracting");
	EXPECT_EQ(said, "Contracting");
}

TEST(Progress, CancelsWhenTheCallbackSaysSo)
{
	int calls = 0;
	const Progress progress([&](int, const char*) { return ++calls < 3; });
	EXPECT_NO_THROW(progress.report(0, "work"));
	EXPECT_NO_THROW(progress.part(0, 0.1).report(0.5, "work"));
	EXPECT_THROW(progress.report(0.2, "work"), Cancelled);
	EXPECT_EQ(calls, 3);
}

TEST(Progress, WhatMustNotEndHalfwayIsShownAndGoesOn)
{
	std::vector<int> percents;
	const Progress progress([&](int percent, const char*) {
		percents.push_back(percent);
		return false;
	});
	const Progress shown = progress.part(0.5, 1).showOnly();
	EXPECT_NO_THROW(shown.report(0, "Writing"));
	EXPECT_NO_THROW(shown.report(1, "Writing"));
	EXPECT_EQ(percents, (std::vector<int> {50, 100}));
	EXPECT_THROW(progress.check(), Cancelled) << "it is the step's business only";
	EXPECT_NO_THROW(Progress().showOnly().report(0.5, "Writing"));
}

TEST(Progress, WhatIsShownOnlyGoesOnFromWhereTheBarIs)
{
	std::vector<int> percents;
	std::string said;
	const Progress progress([&](int percent, const char* what) {
		percents.push_back(percent);
		said = what;
		return true;
	});
	progress.report(0.5, "Measuring");
	const Progress shown = progress.showOnly();
	shown.check();
	EXPECT_EQ(said, "Measuring");
	shown.cancelOnly().report(1, "Copying");
	progress.check();
	EXPECT_EQ(percents, (std::vector<int> {50, 50, 50, 50}));
}

TEST(Progress, IsSilentByDefault)
{
	EXPECT_NO_THROW(Progress().part(0, 0.5).report(1, "work"));
	EXPECT_NO_THROW(Cancellation().check());
}

TEST(Progress, ATokenAsksAndLeavesTheBarWhereItIs)
{
	std::vector<int> percents;
	std::string said;
	bool goesOn = true;
	const Progress progress([&](int percent, const char* what) {
		percents.push_back(percent);
		said = what;
		return goesOn;
	});
	const Cancellation token = progress.part(0.8, 1);
	const Progress hidden = progress.part(0.9, 1).cancelOnly();
	progress.part(0, 0.5).report(0.5, "Contracting");
	token.check();
	hidden.report(1, "Copying");
	hidden.part(0, 0.5).report(1, "Copying");
	EXPECT_EQ(percents, std::vector<int>({25, 25, 25, 25}));
	EXPECT_EQ(said, "Contracting");
	goesOn = false;
	EXPECT_THROW(token.check(), Cancelled);
	EXPECT_THROW(hidden.report(0, "Copying"), Cancelled);
}
