#include "apps/jamscope/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace jamscope {
namespace {

std::string message(const char* text, const Dimension& expected) {
  try {
    to_si(text, expected);
  } catch (const UnitError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Units, ReadEveryUnitOfTheRheometerExactly) {
  EXPECT_EQ(to_si("63 GPa", dimension::pressure), 63e9);
  EXPECT_EQ(to_si("63MPa", dimension::pressure), 63e6);
  EXPECT_EQ(to_si("0.925 mm", dimension::length), 0.925e-3);
  EXPECT_EQ(to_si("925 um", dimension::length), 925e-6);
  EXPECT_EQ(to_si("925 \xc2\xb5m", dimension::length), 925e-6);  // micro sign
  EXPECT_EQ(to_si("  +5e-8 s ", dimension::time), 5e-8);
  EXPECT_EQ(to_si("250 mm/s", dimension::speed), 0.25);
  EXPECT_EQ(to_si("0.274 J/m2", dimension::surface_energy), 0.274);
  EXPECT_EQ(to_si("0.274 J/m^2", dimension::surface_energy), 0.274);
  EXPECT_EQ(to_si("274 mN/m", dimension::surface_energy), 0.274);
  EXPECT_EQ(to_si("2500 kg/m3", dimension::density), 2500);
  EXPECT_NEAR(to_si("2.5 g/cm3", dimension::density), 2500, 1e-9);  // round-off of the database's factor
  EXPECT_EQ(to_si("9.81 m s-2", dimension::acceleration), 9.81);
}

TEST(Units, AcceptTheUsualSpellingsOfDegrees) {
  for (const char* text : {"-5 deg", "-5 degree", "-5 degrees", "-5\xc2\xb0"})
    EXPECT_NEAR(to_si(text, dimension::angle), -5 * std::acos(-1.0) / 180, 1e-16) << text;
  EXPECT_EQ(to_si("0.5 rad", dimension::angle), 0.5);
  // 60 revolutions per minute are one turn per second.
  const Dimension angular_velocity{"an angular velocity", "rad/s", "10 rpm", {0, 0, -1, 1}};
  EXPECT_NEAR(to_si("60 rpm", angular_velocity), 2 * std::acos(-1.0), 1e-15);
}

TEST(Units, WrongDimensionNamesBothDimensions) {
  EXPECT_EQ(message("63 mm", dimension::pressure), "wants a pressure (Pa), got '63 mm' (a length)");
  EXPECT_EQ(message("2 deg", dimension::length), "wants a length (m), got '2 deg' (an angle)");
  EXPECT_EQ(message("2 J/kg", dimension::length), "wants a length (m), got '2 J/kg' (m2 s-2)");
}

TEST(Units, ReciprocalsAndPlainNumbersAreNotConverted) {
  EXPECT_EQ(message("500 Hz", dimension::time), "wants a time (s), got '500 Hz' (a frequency)");
  EXPECT_EQ(message("5 %", dimension::angle), "wants an angle (rad), got '5 %' (a number without dimension)");
}

TEST(Units, ABareNumberIsRefused) {
  EXPECT_EQ(message("52", dimension::length), "wants a length (m), for example \"0.925 mm\"; got '52' without a unit");
}

TEST(Units, WhatIsNotANumberWithAUnitIsRefused) {
  EXPECT_EQ(message("wide", dimension::length),
            "wants a length (m), for example \"0.925 mm\"; got 'wide', which does not begin with a number");
  EXPECT_EQ(message("", dimension::length),
            "wants a length (m), for example \"0.925 mm\"; got '', which does not begin with a number");
  EXPECT_EQ(message("nan mm", dimension::length),
            "wants a length (m), for example \"0.925 mm\"; got 'nan mm', which does not begin with a number");
  EXPECT_EQ(message("1e999 mm", dimension::length), "wants a length (m), got '1e999 mm', which is out of range");
  for (const char* unit : {"mmm", "mm//s", "m)", "(m", "m 5", "mm @ 3", "mm 3 mm", "m s-", "m/", "mm since 2000"})
    EXPECT_EQ(message(("3 " + std::string(unit)).c_str(), dimension::length),
              "wants a length (m), got '3 " + std::string(unit) + "': unknown unit '" + unit + "'");
}

TEST(Units, UnitsWithAnOffsetOrALogarithmAreRefused) {
  EXPECT_EQ(message("20 degC", dimension::length), "wants a length (m), got '20 degC' (a unit that has no place here)");
}

TEST(Units, AreReadTheSameFromManyThreads) {
  std::vector<std::thread> threads;
  std::vector<int> wrong(8, 0);
  for (std::size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&wrong, t] {
      for (int k = 0; k < 200; ++k) wrong[t] += to_si("63 GPa", dimension::pressure) != 63e9;
    });
  for (auto& thread : threads) thread.join();
  for (int w : wrong) EXPECT_EQ(w, 0);
}

}  // namespace
}  // namespace jamscope
