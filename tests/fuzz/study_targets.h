// The readers that stand on more than config and geometry: journals, studies, tables of friction,
// records, receipts.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "calibrate/calibrate.h"
#include "claims/claim.h"
#include "config/describe.h"
#include "design/study.h"
#include "lab/trace_file.h"
#include "lab/trace_reading.h"
#include "optim/journal.h"
#include "report/receipts.h"
#include "scene/measured_table.h"
#include "search/protocol.h"
#include "tests/fuzz/targets.h"
#include "tests/lab/tribometer.h"

namespace papilla::tests {

inline std::vector<FuzzTarget> study_targets(const std::string& folder) {
  // What the study below names.
  for (const std::string name : {"finger.toml", "few_members.toml"})
    write_bytes(folder + "/" + name, read_bytes(PAPILLA_TEST_DATA "/study/" + name));
  std::vector<FuzzTarget> out;
  out.push_back(
      {"study",
       0.03,
       {read_bytes(PAPILLA_TEST_DATA "/study/tiny.toml"), design_text("m3_glass/conformal.toml"),
        design_text("two_level_glass/study.toml"),
        "schema_version = 1\n[texture]\ntype = \"flat\"\n"
        "[[finger.uncertainty]]\nparameter = \"skin.rms\"\ndeviation = \"15 %\"\n"
        "[[finger.uncertainty]]\nparameter = \"load\"\ndeviation = \"3 %\"\ncorrelation = "
        "[-0.4]\n"},
       from_file(folder + "/study.toml", [](const std::string& path) {
         Study study = read_study(path);
         for (const NumberField& n : number_fields(study.design))
           require_finite(*n.value, n.path.c_str());
       })});

  out.push_back(
      {"calibration",
       0.03,
       {design_text("fingers/reference.calibration.toml")},
       from_file(folder + "/calibration.toml", [](const std::string& path) {
         const Calibration calibration = read_calibration(path, m3_claim_ids());
         for (const CalibrationParameter& p : calibration.parameters) {
           for (double v : {p.fit.start, p.fit.low, p.fit.high, p.fit.prior, p.fit.prior_sd})
             require_finite(v, p.path.c_str());
         }
       })});

  const Bytes key = encode(TaskRequest{Stage::Search, 0, false, {1.0 / 7, 0.1}});
  std::string good =
      journal_line({key, encode(search::Judgement{{true, "", {1.0 / 3, 2}, {-0.5}, {7}}, 0.2})});
  std::string failed =
      journal_line({key, encode(TaskAnswer::refused(TaskStatus::Kind::Crashed, "crashed"))});
  good.pop_back();
  failed.pop_back();
  out.push_back({"journal", 0.21, {good, failed}, [](const std::string& bytes) {
                   JournalRecord back;
                   // The checksum: no changed record is taken for a sound one.
                   if (parse_journal_line(bytes, back) && journal_line(back) != bytes + "\n")
                     throw NotFinite{"a changed record is taken for a sound one"};
                 }});

  out.push_back({"friction",
                 0.05,
                 {"design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_"
                  "on_N,F_on_sd_"
                  "N\nm3_samples/flat.toml,15 %,200,5000,0.2,0.06,0.004,0.09,0.005\n"
                  "m3_samples/flat.toml,0.75,200,5000,0.2,0.13,0.01,,\n"},
                 from_file(folder + "/friction.csv", [](const std::string& path) {
                   for (const FrictionDatum& d : read_friction(path).rows) {
                     for (double v : {d.relative_humidity, d.amplitude, d.frequency, d.load, d.off,
                                      d.off_sd, d.on, d.on_sd})
                       require_finite(v, "a cell of the table");
                   }
                 })});

  out.push_back(
      {"table",
       0.03,
       {"experiment,field,design,finger,day,state,repeat,load_N,humidity_percent,voltage_V,"
        "frequency_Hz,F_off_mN,F_off_sd_mN,F_on_mN,F_on_sd_mN\n"
        "E01,A3,flat,Ada,2,clean,1,0.2,15,200,5000,60,4,90,5\n"
        "E02,A4,flat,Ada,2,clean,1,0.2,75,200,5000,130,10,,\n",
        "design;repeat;load [N];relative_humidity;F_off [N]\nflat;2;0.2;15 %;0.06\n"},
       [](const std::string& bytes) {
         for (const MeasuredRow& r : read_measured_table(bytes, "table").rows) {
           for (const auto& v : {r.load, r.relative_humidity, r.voltage, r.frequency, r.off,
                                 r.off_sd, r.on, r.on_sd})
             require_finite(v.value_or(0), "a cell of the table");
         }
       }});

  Tribometer tribometer;
  tribometer.rate = 200, tribometer.strokes = 6;
  out.push_back(
      {"record", 0.01, {tribometer.record("# field: A3\n")}, [](const std::string& bytes) {
         const lab::Trace trace = lab::read_trace(bytes, "record");
         const lab::TraceReading r =
             lab::read_friction_of(trace, lab::find_sliding(trace), "record");
         for (double v : {r.off, r.off_sd, r.on, r.on_sd, r.load, r.voltage, r.lag, r.drift,
                          r.zero_drift, r.peak})
           require_finite(v, "a number of the reading");
       }});

  report::Receipts receipts{"0.1.0", "knee", false, "sum", "study", {}};
  receipts.list.push_back({"r01",
                           {"gain", 0.031, "mN", {0.012, ""}, {{}, "not known"}, {Stage::Confirm}},
                           "0.031",
                           {"run.json#/recommendation"},
                           "sum"});
  out.push_back({"receipts", 0.02, {report::receipts_text(receipts)}, [](const std::string& bytes) {
                   for (const report::Receipt& r :
                        report::read_receipts(bytes, "receipts.json").list) {
                     if (r.number.numerical.size) require_finite(*r.number.numerical.size, "a bar");
                   }
                 }});

  return out;
}

}  // namespace papilla::tests
