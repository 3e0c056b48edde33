/// `topple export`: a recording as tables for other programs.
#include <cstdio>

#include "output.h"
#include "source.h"
#include "text.h"
#include "topple/export.h"
#include "verb.h"

namespace topple::app {
namespace {

class ExportVerb final : public Verb {
 public:
  const char* name() const override { return "export"; }
  const char* purpose() const override { return "Write a recording as CSV (knots or events) or as HDF5"; }
  const char* example() const override { return "topple export scenes/report_row.toml -o hits.csv --events"; }

  void declare(CLI::App& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("-o,--out", output_, "The file to write; its ending says as what")->required()->type_name("FILE.csv|.h5");
    app.add_flag("--events", events_, "The events instead of the knots of all tracks (.csv; an .h5 holds both)");
  }

  int run() override {
    const std::string ending = output_.extension().string();
    if (ending != ".csv" && ending != ".h5") {
      return complain("-o " + output_.string() + ": the name must end in .csv or .h5.", kBadInput);
    }
    if (ending == ".h5" && events_) {
      return complain("--events chooses the table of a .csv; an .h5 file holds the events in any case.", kBadInput);
    }
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) {
      return recording.error();
    }
    const Result<void> written = ending == ".h5" ? export_hdf5(*recording, output_)
                                 : events_       ? export_events_csv(*recording, output_)
                                                 : export_knots_csv(*recording, output_);
    if (!written) {
      return complain(written.error(), kFailed);
    }
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  RunOptions options_;
  std::filesystem::path output_;
  bool events_ = false;
};

}  // namespace

std::unique_ptr<Verb> export_verb() { return std::make_unique<ExportVerb>(); }

}  // namespace topple::app
