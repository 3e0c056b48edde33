/// `topple export`: a recording as tables or as an animated scene for other programs.
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
  const char* purpose() const override { return "Write a recording as CSV (knots or events), as HDF5, or as an animated scene (glTF)"; }
  const char* example() const override { return "topple export scenes/report_row.toml -o hits.csv --events"; }

  void declare(Options& app) override {
    app::declare(app, options_, "RECORDING");
    app.add_option("-o,--out", output_, "The file to write; its ending says as what").required().type_name("FILE.csv|.h5|.glb");
    app.add_flag("--events", events_, "The events instead of the knots of all tracks (.csv; an .h5 holds both)");
    app.add_option(
           "--fps", fps_,
           "Of a .glb: straight keyframes, so many a second, 1 to 240, for programs that leave out the tangents of curves, as Blender "
           "does; without it the curves of the recording")
        .type_name("N")
        .check(whole_number(1, 240));
  }

  int run() override {
    const std::string ending = output_.extension().string();
    if (const std::string why = misused(ending); !why.empty()) return complain(why, kBadInput);
    if (const std::string why = no_place_for(output_); !why.empty()) return complain(why, kFailed);
    const std::expected<Recording, int> recording = open_recording(options_);
    if (!recording) {
      return recording.error();
    }
    const Result<void> written = write(*recording, ending);
    if (!written) {
      return complain(written.error(), kFailed);
    }
    std::fprintf(stderr, "Wrote %s\n", output_.string().c_str());
    return kDone;
  }

 private:
  std::string misused(const std::string& ending) const {
    if (ending != ".csv" && ending != ".h5" && ending != ".glb")
      return "-o " + output_.string() + ": the name must end in .csv, .h5 or .glb.";
    if (events_ && ending == ".h5") return "--events chooses the table of a .csv; an .h5 file holds the events in any case.";
    if (events_ && ending == ".glb") return "--events chooses the table of a .csv; a .glb file has no events.";
    if (fps_ > 0 && ending != ".glb") return "--fps is for the keyframes of a .glb; tables hold the knots of the recording.";
    return {};
  }

  Result<void> write(const Recording& recording, const std::string& ending) const {
    if (ending == ".h5") return export_hdf5(recording, output_);
    if (ending == ".glb") return export_gltf(recording, {.frames = static_cast<double>(fps_)}, output_);
    return events_ ? export_events_csv(recording, output_) : export_knots_csv(recording, output_);
  }

  RunOptions options_;
  std::filesystem::path output_;
  bool events_ = false;
  int fps_ = 0;
};

}  // namespace

std::unique_ptr<Verb> export_verb() { return std::make_unique<ExportVerb>(); }

}  // namespace topple::app
