// The result as JSON, and the page for people.
#include <doctest/doctest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/diagnose/report.hpp"
#include "apps/diagnose/results.hpp"
#include "apps/diagnose/summary.hpp"
#include "apps/diagnose/write_json.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/apps/diagnose_result.hpp"
#include "tests/support/program.hpp"

using diagnose_test::some_diagnosis;
using nlohmann::json;

TEST_CASE("the JSON holds every key of the schema with the values of the diagnosis") {
  const json result = json::parse(diagnose_program::diagnosis_json(some_diagnosis()));
  CHECK(result.at("schema") == "surefoot.diagnosis/1");
  CHECK(result.at("model") == "servo <pendulum>");
  CHECK(result.at("complete") == true);
  CHECK(result.at("verdict") == "missing-physics");
  CHECK(result.at("recordings").at("test") == json({"rec_1.csv", "rec_2.csv"}));
  CHECK(result.at("parameters").at(0) == json({{"name", "kt"},
                                               {"nominal", 1.6},
                                               {"calibrated", 1.48},
                                               {"ci95", {1.45, 1.51}},
                                               {"unit", "N m/A"},
                                               {"at_bound", false},
                                               {"fixed", false}}));
  const json& mismatch = result.at("mismatch");
  CHECK(mismatch.at("channels").at(0).at("rmse_calibrated") == 0.05);
  CHECK(mismatch.at("channels").at(0).at("p_value") == 1e-9);
  CHECK(mismatch.at("regions").at(0).at("share_of_samples") == 0.09);
  CHECK(mismatch.at("intervals").at(0) ==
        json({{"recording", "rec_1.csv"}, {"from", 0.5}, {"to", 0.9}, {"share_of_excess", 0.05}}));
  const json& effect = result.at("effects").at(0);
  CHECK(effect.at("name") == "coulomb_friction");
  CHECK(effect.at("attached_to") == "omega");
  CHECK(effect.at("parameters").at(0).at("ci95") == json({0.115, 0.127}));
  CHECK(effect.at("evidence").at("confidence") == 0.97);
  const json& alternative = result.at("alternatives").at(0);
  CHECK(alternative.at("effects").at(0) == json({{"name", "stribeck_friction"}, {"attached_to", "omega"}}));
  CHECK(alternative.at("probability") == 0.2);
  CHECK(alternative.at("indistinguishable") == true);
  CHECK(result.at("probability") == 0.77);
  const json& structures = result.at("structures");  // the choice, then all others
  REQUIRE(structures.size() == 3);
  CHECK(structures.at(0) == json({{"effects", {{{"name", "coulomb_friction"}, {"attached_to", "omega"}}}},
                                  {"probability", 0.77},
                                  {"heldout_rmse", 0.0041}}));
  CHECK(structures.at(2).at("effects").size() == 2);
  CHECK(structures.at(2).at("probability") == 0.01);
  CHECK(result.at("next_experiment") == "a slow ramp");
  const json& fit = result.at("fit");
  CHECK(fit.at("train").at("rmse_after") == 0.0040);
  CHECK(fit.at("heldout").at("rmse_before") == 0.052);
  CHECK(fit.at("heldout").at("per_recording").at(1) ==
        json({{"recording", "rec_2.csv"}, {"before", 0.06}, {"after", 0.005}, {"beyond_noise", true}}));
  CHECK(fit.at("heldout").at("rmse_forest") == 0.011);
  CHECK(result.at("log_faults").at(0) == json({{"kind", "sign_flipped"},
                                               {"recording", "rec_4.csv"},
                                               {"channel", "theta_rad"},
                                               {"size", -1.0},
                                               {"unit", ""},
                                               {"sentence", "rec_4.csv: theta_rad has the opposite sign"},
                                               {"cure", "flip its sign"},
                                               {"repaired", false}}));
  CHECK(result.at("noise").at(0) ==
        json({{"name", "correlated_noise"},
              {"output", "theta_rad"},
              {"parameters",
               {{{"name", "time"}, {"value", 0.03}, {"ci95", {0.025, 0.036}}, {"unit", "s"}, {"at_bound", false}}}},
              {"evidence", {{"likelihood_gain", 0.12}, {"p_value", 1e-6}}},
              {"sentence", "noise of theta_rad is correlated over 0.03 s"}}));
  CHECK(result.at("forest_residual") == json({{"kept", true},
                                              {"heldout_rmse", 0.0021},
                                              {"heldout_rmse_without", 0.0041},
                                              {"gain", 0.4},
                                              {"gain_stderr", 0.05},
                                              {"file", "residual.forest"}}));
  CHECK(result.at("seconds") == 12.3);
  CHECK(result.at("seed") == 7);
}

TEST_CASE("numbers that are not finite are null, and names that are no UTF-8 do not break the JSON") {
  surefoot::Diagnosis diagnosis = some_diagnosis();
  diagnosis.held_out_forest = std::numeric_limits<double>::quiet_NaN();
  diagnosis.parameters[0].fit.low = -std::numeric_limits<double>::infinity();
  diagnosis.model = "caf\xE9";
  const json result = json::parse(diagnose_program::diagnosis_json(diagnosis));
  CHECK(result.at("fit").at("heldout").at("rmse_forest").is_null());
  CHECK(result.at("parameters").at(0).at("ci95").at(0).is_null());
}

TEST_CASE("every verdict has its name") {
  using surefoot::Verdict;
  CHECK(diagnose_program::verdict_text(Verdict::adequate) == "adequate");
  CHECK(diagnose_program::verdict_text(Verdict::parameters_only) == "parameters-only");
  CHECK(diagnose_program::verdict_text(Verdict::missing_physics) == "missing-physics");
  CHECK(diagnose_program::verdict_text(Verdict::unexplained) == "unexplained");
}

TEST_CASE("an empty diagnosis is written without a complaint") {
  const surefoot::Diagnosis nothing;
  const json result = json::parse(diagnose_program::diagnosis_json(nothing));
  CHECK(result.at("effects").empty());
  CHECK(result.at("noise").empty());
  CHECK(result.at("forest_residual").at("kept") == false);
  CHECK(diagnose_program::make_report(nothing, {}).html.find("</html>") != std::string::npos);
  CHECK(!diagnose_program::summary(nothing, "out").empty());
}

TEST_CASE("the summary fits on a screen and names the effect with its interval") {
  const std::string text = diagnose_program::summary(some_diagnosis(), "out");
  CHECK(std::count(text.begin(), text.end(), '\n') <= 15);
  CHECK(text.find("noise of theta_rad is correlated over 0.03 s") != std::string::npos);
  CHECK(text.find("residual.forest, a forest that corrects") != std::string::npos);
  CHECK(text.find("coulomb_friction at omega, level 0.121 N m (0.115 to 0.127)") != std::string::npos);
}

TEST_CASE("the page holds all parts, escapes names and needs nothing from outside") {
  const auto report = diagnose_program::make_report(some_diagnosis(), diagnose_test::some_simulator());
  const std::string& html = report.html;
  for (const char* part :
       {"Physics is missing", "Where the model is off", "What is missing", "Before and after", "Other candidates",
        "Next experiment", "Parameters", "The recordings", "What the noise is like", "A forest in place of physics",
        "servo &lt;pendulum&gt;", "width=device-width"}) {
    CAPTURE(part);
    CHECK(html.find(part) != std::string::npos);
  }
  CHECK(html.find("servo <pendulum>") == std::string::npos);
  CHECK(html.find("src=") == std::string::npos);
  CHECK(html.find("href=") == std::string::npos);
  REQUIRE(report.pictures.size() == 2);
  CHECK(report.pictures[0].svg.starts_with("<svg"));
  CHECK(report.pictures[0].svg.find("class=\"mark\"") != std::string::npos);
  CHECK(report.pictures[0].svg.find("nan") == std::string::npos);
}

TEST_CASE("a residual forest is written only where one is kept, and one of an earlier diagnosis goes") {
  const approach_program::ScratchFolder folder;
  const std::string file = folder.file("residual.forest");
  surefoot::Diagnosis diagnosis = some_diagnosis();
  auto& model = diagnosis.forest_residual.model;
  model.features = {"theta"};
  model.outputs = {"theta_rad"};
  model.scale = Eigen::VectorXd::Constant(1, 0.01);
  surefoot::Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = Eigen::MatrixXf::Random(1, 50);
  samples.outputs = Eigen::MatrixXd::Random(1, 50);
  model.forest = surefoot::train_extra_trees(samples, {.trees = 3}, surefoot::Serial{}, 1);
  diagnose_program::write_results(diagnosis, diagnose_test::some_simulator(), folder.path(), nullptr);
  CHECK(surefoot::load_residual_model(file).forest == model.forest);
  diagnosis.forest_residual.kept = false;
  diagnose_program::write_results(diagnosis, diagnose_test::some_simulator(), folder.path(), nullptr);
  CHECK(!std::filesystem::exists(file));
}
