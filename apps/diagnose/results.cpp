#include "results.hpp"

#include <fstream>
#include <iostream>
#include <system_error>

#include "report.hpp"
#include "summary.hpp"
#include "surefoot/core/binary.hpp"
#include "write_augmented.hpp"
#include "write_cpp.hpp"
#include "write_json.hpp"

namespace diagnose_program {

void prepare_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  const std::filesystem::path probe = folder / "diagnosis.json.part";
  const bool written = std::ofstream(probe, std::ios::binary).is_open();
  std::filesystem::remove(probe, failed);
  if (!written) {
    throw surefoot::DiagnoseError("--out: no file can be written in " + folder.string() +
                                  "; choose a folder that you may write to");
  }
}

void write_results(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info,
                   const std::filesystem::path& folder, const ModelFile* model) {
  const Report report = make_report(diagnosis, info);
  for (const Picture& picture : report.pictures) {
    surefoot::write_file_atomically(folder / (picture.name + ".svg"), picture.svg);
  }
  surefoot::write_file_atomically(folder / "report.html", report.html);
  if (model != nullptr) {
    const std::string head = "# " + model->file + ", calibrated" +
                             (diagnosis.effects.empty() ? "" : " and with the effects that were found missing") + "\n";
    const ModelFile augmented = augmented_model(*model, diagnosis);
    surefoot::write_file_atomically(folder / "augmented.toml", head + model_text(augmented));
    surefoot::write_file_atomically(folder / "augmented.hpp", model_header(augmented, diagnosis));
  }
  std::error_code none;
  std::filesystem::remove(folder / residual_file, none);  // of an earlier diagnosis
  if (diagnosis.forest_residual.kept) {
    surefoot::save_residual_model(diagnosis.forest_residual.model, folder / residual_file);
  }
  surefoot::write_file_atomically(folder / "diagnosis.json", diagnosis_json(diagnosis));  // last: all is there
}

void print_summary(const surefoot::Diagnosis& diagnosis, const std::filesystem::path& folder) {
  std::cout << summary(diagnosis, folder) << std::flush;
}

}  // namespace diagnose_program
