// What the physics pieces exchange: where the water is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/grid.h"

namespace papilla::maps {

enum class DropletState : std::uint8_t { OnSkin, OnSubstrate, Bridge };

struct Droplet {
  double x = 0, y = 0;  // centre [m], inside the patch
  double volume = 0;    // [m^3]
  DropletState state = DropletState::OnSubstrate;
  double radius = 0;    // footprint [m]
  double height = 0;    // cap height [m] (bridge: mean gap under the footprint)
  double edge_gap = 0;  // bridge: mean gap on the rim [m]
  double force = 0;     // bridge: normal force dE/dh [N], positive = attracts
  double energy = 0;    // [J]
  double film = 0;  // share of film in a wide bridge, 1: all film; the film's force is no part of
                    // its own, which is that of what is still a disc
};

enum class WettingStatus : std::uint8_t { Dry, Discs, Flooded, Film };

// State of a pixel: no film, water on its way from disc to film, film.
enum class FilmPixel : std::uint8_t { None, OnItsWay, Film };

struct Wetting {
  Grid grid;
  std::vector<Droplet> droplets;
  WettingStatus status = WettingStatus::Dry;
  std::vector<std::uint8_t> bridged;  // per pixel: 1 inside a bridge (or the film); empty: dry
  std::vector<FilmPixel> film;        // per pixel; empty: none
  std::vector<int> film_region;       // per pixel of a film: 1 + its connected region, 0: none
  std::vector<double> film_pressure;  // of each region: its force over its pixels [Pa]
  double capillary_force = 0;         // total normal force on the patch [N], positive = attracts
  double wetted_fraction = 0;         // bridged area / patch area
  double volume = 0;                  // total [m^3]
  double bridge_volume = 0;           // of it in bridges
  double wicked_volume = 0;           // of it in corners at the feet of walls
  int bridges = 0;
  double retention = 0;  // lateral hysteresis force [N]
};

}  // namespace papilla::maps
