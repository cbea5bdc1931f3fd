// A source, a finger and what lies between as a file (`papilla solve drive`): forces over time and
// frequency, and what limits the drive.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/reader.h"
#include "physics/drive/network.h"
#include "physics/drive/signal.h"
#include "physics/drive/stiction.h"
#include "scene/environment.h"

namespace papilla::cases {

// The gap: given, or that of a design's solved patches.
struct GapSettings {
  double distance = 1.06e-6;   // [m]
  double resistivity = 4.8e8;  // [ohm m]; 0: an insulator
  double permittivity = 1;
  // File; then distance, surface, skin and area come from it, at the load of the case's touch.
  std::string design;
  bool contact_spots = false;       // of that design conduct beside the gap
  double relative_humidity = 0.55;  // of that design
  int skins = 4;                    // patches that are averaged
};
void fields(FieldVisitor& v, GapSettings& s);

struct CoatingSettings {
  std::vector<Dielectric> dielectric = {{"oxide", 1e-6, 3.9, 1e14, 1e9}};
};
void fields(FieldVisitor& v, CoatingSettings& s);

struct SkinLayerSettings {
  double thickness = 200e-6, permittivity = 2000, resistivity = 2e4;  // of the stratum corneum
};
void fields(FieldVisitor& v, SkinLayerSettings& s);

struct DriveTouch {
  double load = 1;           // [N]
  double area = 30e-6;       // electrical contact area [m^2]
  double coefficient = 0.2;  // friction = coefficient (load + pull)
  double real_area = 0;      // in true contact [m^2]; 0: not known, no onset
  double shear_strength = 9e6;
};
void fields(FieldVisitor& v, DriveTouch& s);

struct Tones {
  std::vector<double> frequency;  // [Hz]; empty: drive.modulation_frequency at full depth
  std::vector<double> amplitude;  // relative; empty: equal, 1 in all
};
void fields(FieldVisitor& v, Tones& s);

struct SourceSettings {
  double shunt = 1e6;        // across a current source [ohm]; 0: none
  std::string file;          // instead of the drive's waveform: a recording that repeats
  double chirp_to = 0;       // instead: a sine from the drive's frequency to this one [Hz]; 0: none
  double chirp_time = 0.05;  // in so long [s]
};
void fields(FieldVisitor& v, SourceSettings& s);

// The finger of a rendered swipe.
struct SwipeSettings {
  double stroke = 10e-3, frequency = 3.8, duration = 1;  // amplitude [m], [Hz], [s]
  double stiffness = 800;                                // [N/m]
  double filter = 150;                                   // low-pass on forces [Hz]; 0: none
  double stuck = 1, partial = 1, full = 0;               // current in each state, of the drive's

  StictionOptions machine(double current) const;
};
void fields(FieldVisitor& v, SwipeSettings& s);

struct ResponseSweep {
  std::vector<double> frequency;  // [Hz]; of a plain sine
};
void fields(FieldVisitor& v, ResponseSweep& s);

struct DriveCase {
  int schema_version = 1;
  std::string title;
  Drive drive;
  SourceSettings source;
  Tones tones;
  GapSettings gap;
  CoatingSettings surface;
  SkinLayerSettings skin;
  DriveTouch touch;
  ResponseSweep sweep;
  SwipeSettings swipe;
  Signal recording;  // of source.file; empty: none

  // By its tones: of amplitude modulation, which a recording replaces.
  bool modulated() const { return drive.waveform == Waveform::Am && recording.value.empty(); }
};
void fields(FieldVisitor& v, DriveCase& s);

// Throws InputError with every problem.
DriveCase read_drive_case(const std::string& path, const std::vector<std::string>& overrides = {});
DriveCase read_drive_case(Document document);

enum class DriveLimit { BodyCurrent, SourceVoltage, GapVoltage, FilmVoltage };

struct DriveCheck {
  DriveLimit what;
  double value = 0, limit = 0;  // SI; passes while value <= limit
  bool passes() const { return value <= limit; }
};

struct DriveResult {
  Network network;
  double area = 0;                      // [m^2]
  double spots = 0;                     // resistance of the contact spots [ohm]; 0: not known
  DriveResponse carrier;                // unmodulated, at the drive's frequency and peak amplitude
  Modulation modulation;                // where the case is modulated
  ForceSeries series;                   // one common period
  Signal friction;                      // coefficient (load + pull) [N]
  double distortion = 0;                // of the friction below half the carrier; where modulated
  std::vector<SpectrumLine> lines;      // of the friction, 1e-6 of the largest and above
  std::vector<DriveResponse> response;  // one per frequency of the sweep
  // Body current, source compliance, air in the gap, strength of the film; of a compliance and a
  // film where there are some.
  std::vector<DriveCheck> checks;
  // Onset of sliding [N], Eq. drive.6: undriven, driven, driven with all of the patch in static
  // contact; 0 without touch.real_area.
  double onset_off = 0, onset_on = 0, onset_static = 0;
};
// Milliseconds with a given gap, seconds with a design's. Throws InputError for frequencies without
// a common period.
DriveResult solve_drive(const DriveCase& c);

// A swipe through the state machine of rendered stickiness: Eq. drive.10.
struct SwipeStep {
  double time = 0;  // [s] of entering the state
  SlipState state = SlipState::Idle;
  double current = 0;  // [A] peak, from then on
};
struct Swipe {
  std::vector<SwipeStep> steps;
  double duration = 0, driven = 0;     // [s]; driven: with current
  std::vector<RubbingSample> samples;  // of a rendered one
  bool without_tones = false;          // of a rendered one: the case has some
};
// The machine that asks for shares of a case's current. Throws InputError where the drive is no
// current.
StictionOptions swipe_machine(const DriveCase& c);
// Of recorded forces: lines "lateral,normal" [N], one per step of the options and low-passed
// before; or "time,lateral,normal" [s] at any even rate above twice the filter's corner, which are
// low-passed and taken at the steps of the options here. Below a head the columns are in its order
// and units. Throws InputError naming `name` and the line.
Swipe run_swipe(const std::string& csv, const std::string& name, const StictionOptions& options,
                double filter);
// The loop closed: the finger of the case drags to and fro, and the current that the machine asks
// for pulls it. That is the amplitude of the carrier, sine, square or constant, in the place of any
// tones. Throws InputError where the drive is no current, or is recorded or a chirp.
Swipe render_swipe(const DriveCase& c, const Network& network);

}  // namespace papilla::cases
