// Model files: what is read, and that each mistake is named with its place and its cure.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "apps/diagnose/equation_plan.hpp"
#include "apps/diagnose/known_effects.hpp"
#include "apps/diagnose/model_file.hpp"
#include "apps/diagnose/units.hpp"
#include "apps/diagnose/write_augmented.hpp"
#include "surefoot/diagnose/effects/catalogue.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "tests/apps/diagnose_models.hpp"

using diagnose_program::parse_model_file;
using diagnose_test::servo_model;
using diagnose_test::walk_model;
using diagnose_test::with;

namespace {

void check_model_refused(const std::string& text, const std::string& words) {
  CAPTURE(words);
  REQUIRE(!text.empty());
  try {
    parse_model_file(text, "servo.toml");
    FAIL("not refused");
  } catch (const surefoot::DiagnoseError& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK(what.find("servo.toml") == 0);
    CHECK(what.find(words) != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

}  // namespace

TEST_CASE("a model file is read in the order of its lines") {
  const auto model = parse_model_file(servo_model, "servo.toml");
  CHECK(model.name == "servo pendulum");
  REQUIRE(model.lets.size() == 3);
  CHECK(model.lets[0].name == "duty");
  CHECK(model.lets[2].name == "inertia");
  CHECK(model.states[1].name == "omega");
  CHECK(model.states[1].effort_unit == "N m");
  CHECK(model.inputs[0].unit == "rad");
  CHECK(model.constants[1].meta == "mass_kg");
  CHECK(model.parameters[2].high == 0.1);
  CHECK(model.outputs[0].noise == 0.001);
}

TEST_CASE("a map may have sequences, measurements after the step and planar motion") {
  const auto model = parse_model_file(walk_model, "walk.toml");
  CHECK(model.kind == surefoot::SimulatorKind::map);
  CHECK(model.sequence == "seq");
  CHECK(model.measured_after_step);
  REQUIRE(model.planar);
  CHECK(model.planar->forward == "dx");
}

TEST_CASE("the process noise of a map is that of a row; an ode has none") {
  const auto model =
      parse_model_file(with(walk_model, "value = \"x\"", "value = \"x\", process_noise = 0.02"), "walk.toml");
  CHECK(model.outputs[0].process_noise == 0.02);
  CHECK(std::isnan(model.outputs[1].process_noise));
  check_model_refused(with(walk_model, "value = \"x\"", "value = \"x\", process_noise = 0"), "above 0 is expected");
  check_model_refused(with(servo_model, "noise = 0.001", "process_noise = 0.001"), "is for kind = \"map\" only");
}

TEST_CASE("a model that was written reads back the same") {
  for (const std::string& text : {servo_model, walk_model}) {
    const auto model = parse_model_file(text, "a.toml");
    const std::string once = diagnose_program::model_text(model);
    CHECK(diagnose_program::model_text(parse_model_file(once, "a.toml")) == once);
  }
}

TEST_CASE("an augmented model holds the calibrated parameters and the effects, and reads back") {
  surefoot::Diagnosis diagnosis;
  diagnosis.parameters.push_back({{"kt", "N m/A", 1.5, 1.4, 1.6}, 1.6});
  diagnosis.parameters.push_back({{"R", "ohm", 15.0000001, 14, 16}, 3.6, true});
  diagnosis.effects.push_back({"overflow", "omega", "", {{"level", "N m", 0.12, 0.11, 0.13}}, {}, "spill", "theta"});
  const auto model = parse_model_file(servo_model, "servo.toml");
  const auto back = parse_model_file(model_text(augmented_model(model, diagnosis)), "augmented.toml");
  CHECK(back.parameters[0].value == 1.5);
  CHECK(back.parameters[1].value == 15);  // kept within its bounds
  REQUIRE(back.effects.size() == 1);
  CHECK(back.effects[0].name == "overflow");
  CHECK(back.effects[0].attached_to == "omega");
  CHECK(back.effects[0].with == "theta");
  CHECK(back.effects[0].form == "spill");
  CHECK(back.effects[0].parameters[0].value == 0.12);
}

TEST_CASE("the bounds of an effect that is read back reach no further than those of the search") {
  surefoot::Diagnosis diagnosis;
  surefoot::FittedValue exponent{"exponent", "", 1, 0.1, 1.9};
  exponent.least = 0.4;
  exponent.most = 2;
  diagnosis.effects.push_back({"stribeck_friction", "omega", "", {exponent}, {}, "tailed", ""});
  diagnosis.effects.back().parameters.push_back({"level", "N m", 0.12, 0.11, 0.13});
  const auto model = augmented_model(parse_model_file(servo_model, "servo.toml"), diagnosis);
  CHECK(model.effects[0].parameters[0].low == 0.4);
  CHECK(model.effects[0].parameters[0].high == 2);
  CHECK(model.effects[0].parameters[1].high == doctest::Approx(0.15));  // thrice the interval
}

TEST_CASE("effects of a model file are found in the library") {
  const std::string friction =
      "[[effects]]\nname = \"coulomb_friction\"\nattached_to = \"omega\"\n[effects.parameters]\nlevel = 0.1\n";
  const auto library = surefoot::all_effects();
  const auto known = [&library](const std::string& text) {
    const auto model = parse_model_file(text, "servo.toml");
    CHECK(model_text(parse_model_file(model_text(model), "again.toml")) == model_text(model));
    return diagnose_program::known_effects(model, library);
  };
  const auto found = known(servo_model + friction);
  REQUIRE(found.size() == 1);
  CHECK(found[0].name == "coulomb_friction");
  CHECK(found[0].values == std::vector<double>{0.1});
  REQUIRE(found[0].bounds.size() == 1);
  CHECK(std::isnan(found[0].bounds[0].low));  // those of the library
  const auto bounded = known(servo_model + with(friction, "0.1", "{ value = 0.1, min = 0.05, max = 9 }"));
  CHECK(bounded[0].bounds[0].low == 0.05);
  CHECK(bounded[0].bounds[0].high == 9);
  const auto fixed = known(servo_model + with(friction, "0.1", "{ value = 0.1, fixed = true }"));
  CHECK(fixed[0].bounds[0].low == 0.1);
  CHECK(fixed[0].bounds[0].high == 0.1);
  CHECK_THROWS_WITH_AS(
      known(servo_model + with(friction, "coulomb", "colomb")),
      "servo.toml, line 32, [[effects]]: there is no effect 'colomb_friction'; did you mean 'coulomb_friction'?",
      surefoot::DiagnoseError);
  CHECK_THROWS_WITH_AS(
      known(servo_model + with(friction, "level", "height")),
      "servo.toml, line 32, [[effects]]: the effect 'coulomb_friction' needs the parameters level, all of "
      "them and no other",
      surefoot::DiagnoseError);
}

TEST_CASE("text that is no TOML is refused with its line") {
  check_model_refused(with(servo_model, "[let]", "[let"), "line 9");
  check_model_refused(" ", "the key 'schema' is missing");
}

TEST_CASE("text that is no UTF-8 is refused with its line") {
  CHECK_THROWS_WITH_AS(parse_model_file("# in degrees\nname = '20 \260C'\n", "model.toml"),
                       doctest::Contains("model.toml, line 2: a byte that is no UTF-8 text"), surefoot::DiagnoseError);
}

TEST_CASE("an unknown key is refused, and the nearest known one proposed") {
  check_model_refused("speling = 1\n" + servo_model, "line 1: unknown key 'speling'");
  check_model_refused(with(servo_model, "noise = 0.001", "nose = 0.001"), "unknown key 'nose'; did you mean 'noise'?");
  check_model_refused(with(servo_model, "[parameters]", "[paramters]"),
                      "unknown key 'paramters'; did you mean 'parameters'?");
}

TEST_CASE("missing keys and tables are named with what they are for") {
  check_model_refused(with(servo_model, "name   = \"servo pendulum\"\n", ""), "the key 'name' is missing");
  check_model_refused(with(servo_model, "time   = \"t_s\"\n", ""), "the key 'time' is missing");
  check_model_refused("schema = \"surefoot.model/1\"\nname = \"x\"\nkind = \"map\"\n", "the table [states] is missing");
  check_model_refused(with(servo_model, "rate = \"omega\", ", ""),
                      "line 15, [states] theta: the key 'rate' is missing");
  check_model_refused(with(servo_model, ", initial = \"0\"", ""), "[states] omega: the key 'initial' is missing");
}

TEST_CASE("a missing unit is refused") {
  check_model_refused(with(servo_model, "unit = \"rad\", noise", "noise"), "the key 'unit' is missing");
  check_model_refused(with(servo_model, "\"goal_rad\"", "\"goal\""),
                      "line 7, [inputs] goal: the column 'goal' does not end in its unit");
  check_model_refused(with(servo_model, "theta_rad = {", "theta = {"),
                      "[outputs] theta: the column 'theta' does not end in its unit");
  check_model_refused(with(servo_model, "unit = \"rad\", noise", "unit = \"deg\", noise"),
                      "the column's name ends in rad");
}

TEST_CASE("a state that begins with a column has the unit of that column") {
  check_model_refused(
      with(servo_model, "column:theta_rad", "column:theta_deg"),
      "the column 'theta_deg' is not in the unit of the state, rad: name a column that is, or begin with "
      "initial = \"free\"");
}

TEST_CASE("a parameter without a unit is a plain number") {
  const auto model = parse_model_file(with(servo_model, ", unit = \"ohm\"", ""), "servo.toml");
  const auto place = std::ranges::find(model.parameters, "R", &surefoot::ParameterInfo::name);
  REQUIRE(place != model.parameters.end());
  CHECK(place->unit == "1");
}

TEST_CASE("a unit may be written as the column's name ends") {
  CHECK(diagnose_program::unit_fits("heater_degC", "degC"));
  CHECK(diagnose_program::unit_fits("flow_L_min", "L/min"));
  CHECK(diagnose_program::unit_fits("flow_L_s", "L/s"));
  for (const auto& [column, unit] : std::vector<std::pair<std::string, std::string>>{{"flow_mL_s", "mL/s"},
                                                                                     {"rate_degC_min", "C/min"},
                                                                                     {"v_km_h", "km/h"},
                                                                                     {"impulse_N_s", "N s"},
                                                                                     {"t_s", "s"},
                                                                                     {"speed_rad_s", "rad/s"},
                                                                                     {"level_norm_s", "s"}}) {
    CHECK(diagnose_program::unit_of_column(column) == unit);
  }
  CHECK(diagnose_program::unit_fits("heater_degC", "C"));
  CHECK_FALSE(diagnose_program::unit_fits("heater_degC", "K"));
  CHECK(diagnose_program::unit_fits("conc_g_l", "g/l"));
  CHECK(diagnose_program::unit_fits("conc_kg_m3", "kg/m^3"));
  CHECK_FALSE(diagnose_program::unit_fits("conc_kg_m3", "g/l"));
  CHECK_FALSE(diagnose_program::unit_fits("speed_m_s", "rad"));
}

TEST_CASE("schema and kind must be known") {
  check_model_refused(with(servo_model, "surefoot.model/1", "surefoot.model/2"),
                      "line 1, schema: only \"surefoot.model/1\" is known");
  check_model_refused(with(servo_model, "\"ode\"", "\"dae\""), "line 3, kind: 'dae' is no kind");
  check_model_refused(with(servo_model, "\"t_s\"", "\"t_ms\""), "line 4, time: the column 't_ms' must be in seconds");
}

TEST_CASE("a parameter outside its bounds is refused") {
  check_model_refused(with(servo_model, "value = 1.6", "value = 6.1"),
                      "line 29, [parameters] kt: the value 6.1 lies outside its bounds, 0.3 to 5");
  check_model_refused(with(servo_model, "min = 0.3, max = 5.0", "min = 5.0, max = 0.3"), "min is above max");
  check_model_refused(with(servo_model, "value = 1.6", "value = \"1.6\""),
                      "[parameters] kt value: a finite number is expected");
  check_model_refused(with(servo_model, "value = 1.6", "value = inf"),
                      "[parameters] kt value: a finite number is expected");
}

TEST_CASE("a name can be used once, and not that of a function") {
  check_model_refused(with(servo_model, "R = {", "tau = {"),
                      "the name 'tau' is used twice, in [parameters] and in [let]");
  check_model_refused(with(servo_model, "g = 9.81", "sin = 9.81"),
                      "[constants] sin: the name 'sin' is that of a function");
  check_model_refused(with(servo_model, "g = 9.81", "pi = 3"), "the name 'pi' is that of a function");
  check_model_refused(with(servo_model, "g = 9.81", "\"g-force\" = 9.81"),
                      "the name 'g-force' cannot be used in expressions");
}

TEST_CASE("a let may use neither itself nor what stands further down") {
  check_model_refused(with(servo_model, "\"kt/R*(vin*duty", "\"kt/R*(tau*duty"),
                      "line 11, [let] tau: the expression uses 'tau' itself");
  check_model_refused(
      with(servo_model, "min(max(kp*(goal", "min(max(tau*(goal"),
      "line 10, [let] duty: the expression uses 'tau', which in turn needs 'duty'; lets cannot go in a circle");
  check_model_refused(with(servo_model, "min(max(kp*(goal", "min(max(inertia*(goal"),
                      "line 10, [let] duty: the expression uses 'inertia', which stands further down");
}

TEST_CASE("an unknown name in an expression is refused, and a near one proposed") {
  check_model_refused(with(servo_model, "\"(tau - mass", "\"(tao - mass"),
                      "line 16, [states] omega rate: the expression uses the unknown name 'tao'; did you mean 'tau'?");
  check_model_refused(with(servo_model, "value = \"theta\"", "value = \"angle\""),
                      "[outputs] theta_rad value: the expression uses the unknown name 'angle'");
  check_model_refused(with(servo_model, "initial = \"0\"", "initial = \"theta\""),
                      "[states] omega initial: the expression uses the unknown name 'theta'");
  check_model_refused(
      with(servo_model, "effort = \"inertia\"", "effort = \"inertial\""),
      "[states] omega effort: the expression uses the unknown name 'inertial'; did you mean 'inertia'?");
}

TEST_CASE("an expression that cannot be read is refused with the place in it") {
  check_model_refused(with(servo_model, "sin(theta)", "sin(theta"),
                      "at character 40 of the expression a ')' is expected, found its end");
  check_model_refused(with(servo_model, "sin(theta)", "sine(theta)"),
                      "there is no function 'sine'; did you mean 'sin'?");
  check_model_refused(with(servo_model, "sin(theta)", "sin(theta, 1)"), "the function 'sin' takes 1");
  check_model_refused(with(servo_model, "\"omega\"", "\"omega omega\""),
                      "at character 7 of the expression an operator or the end is expected");
  check_model_refused(with(servo_model, "\"omega\"", "\"\""), "the expression is empty");
  check_model_refused(with(servo_model, "\"omega\"", "\"" + std::string(5000, '(') + "\""), "nested");
  check_model_refused(with(servo_model, "\"omega\"", "\"" + std::string(5000, '-') + "1\""), "nested");
}

TEST_CASE("an effort needs its unit") {
  check_model_refused(with(servo_model, ", effort_unit = \"N m\"", ""),
                      "'effort' and 'effort_unit' belong together; 'effort_unit' is missing");
  check_model_refused(with(servo_model, "effort = \"inertia\", ", ""), "'effort' is missing");
}

TEST_CASE("a force has a name of its own, a unit, and rates that use it in a sum") {
  using diagnose_test::crane_model;
  CHECK(parse_model_file(crane_model, "servo.toml").states[1].force == "rub");
  const auto refused = [](const std::string& from, const std::string& to, const std::string& words) {
    check_model_refused(with(crane_model, from, to), words);
  };
  refused("drive + rub", "drive", "[states] v force: no rate uses 'rub'; add it");
  refused(R"(force = "rub", effort_unit = "N" })", R"(force = "rub" })", "'effort_unit', its unit, is missing");
  refused(R"(force = "rub",)", R"(effort = "M", force = "rub",)", "leave 'effort' out");
  refused(R"(force = "rub",)", R"(force = "push",)", "the name 'push' is used twice");
  refused(R"(force = "rub",)", R"(force = "2 r",)", "cannot be used in expressions");
  check_model_refused(
      with(walk_model, "next = \"th + turn\"", "force = \"f\", effort_unit = \"N\", next = \"th + turn\""),
      "leave it out of a map");
  const auto curved = parse_model_file(with(crane_model, "drive + rub", "drive + tanh(rub)"), "servo.toml");
  CHECK_THROWS_WITH_AS(diagnose_program::plan_equations(curved), doctest::Contains("rates are linear in forces"),
                       surefoot::DiagnoseError);
}

TEST_CASE("planar keys must be states and lets") {
  check_model_refused(with(walk_model, "heading = \"th\"", "heading = \"yaw\""), "[planar] heading: 'yaw' is no state");
  check_model_refused(with(walk_model, "y = \"y\"", "y = \"x\""), "three different states");
  check_model_refused(with(walk_model, "forward = \"dx\"", "forward = \"ahead\""),
                      "[planar] forward: 'ahead' stands neither in [let]");
  check_model_refused(servo_model + "[planar]\nx = \"theta\"\ny = \"omega\"\nheading = \"theta\"\n",
                      "planar motion is for kind = \"map\" only");
}

TEST_CASE("rates belong to an ode, next values to a map") {
  check_model_refused(with(walk_model, "next = \"th + turn\"", "rate = \"turn\""), "'rate' belongs to kind = \"ode\"");
  check_model_refused(with(servo_model, "rate = \"omega\"", "next = \"omega\""), "'next' belongs to kind = \"map\"");
}

TEST_CASE("more than sixteen states are refused") {
  std::string states = "[states]\n";
  for (int i = 0; i < 17; ++i) states += "s" + std::to_string(i) + " = { rate = \"1\", initial = 0, unit = \"m\" }\n";
  check_model_refused(with(servo_model, "[states]\n", states), "at most 16");
}
