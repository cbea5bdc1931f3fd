// What a client of bad will or bad manners cannot do.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "base/files.h"
#include "tests/studio/loopback.h"
#include "tests/support/thorough.h"
#include "tests/temporary.h"

namespace papilla::tests::hostile_slow_test {
namespace {

namespace fs = std::filesystem;

// A design that is refined in no time to speak of: what is tried is the server.
StudioOptions quick_studio(const fs::path& folder) {
  StudioOptions options = studio_options(folder.string());
  options.file = (folder / "quick.toml").string();
  write_bytes(options.file,
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[environment]\n"
              "relative_humidity = [\"35 %\"]\n[accuracy]\ngrid = 32\n");
  return options;
}

TEST(Limits, EndASlowRequestAndOneConnectionTooMany) {
  const TemporaryFolder folder;
  StudioOptions options = quick_studio(folder.path());
  options.limits.request = std::chrono::seconds{1};
  options.limits.idle = std::chrono::seconds{1};
  options.limits.connections = 4;
  const Studio studio(options);
  const Place place(studio.address());
  {
    Connection slow(place.port);
    slow.send("GET " + place.root);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 40 && slow.send("a"); ++i) {  // a letter each tenth of a second
      slow.read_until("never", 0.1);
      if (slow.closed()) break;
    }
    EXPECT_TRUE(slow.closed());
    const std::chrono::duration<double> held = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(held.count(), 3.5);
  }
  std::vector<std::unique_ptr<Connection>> held;
  for (int i = 0; i < 12; ++i) {
    held.push_back(std::make_unique<Connection>(place.port));
    held.back()->read_until("never", 0.02);
  }
  int ended = 0;  // the oldest make room for the newest
  for (auto& connection : held) {
    connection->read_until("never", 0.02);
    ended += connection->closed();
  }
  EXPECT_GE(ended, 12 - 5);
  EXPECT_FALSE(held.back()->closed());
  held.clear();
  EXPECT_EQ(replied(place, place.own("GET", "page/studio.css")).status, 200);
}

// Of this process, in MB: resident memory without the libraries that a first image loads.
double resident() {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("RssAnon:")) return 1e-3 * std::stod(line.substr(8));
  }
  return 0;
}

// The memory of an evaluation is there.
bool told_of_a_refined_design(const Place& place, Connection& listener) {
  listener.send(place.own("GET", "events"));
  const std::string refined = R"("step":"design")";
  return listener.read_until(refined, 120).find(refined) != std::string::npos;
}

// 200 connections at once that send half a head, then a letter each second.
TEST(SlowClients, NeitherKeepOthersOutNorFillTheMemory) {
  const TemporaryFolder folder;
  StudioOptions options = quick_studio(folder.path());
  options.limits.request = std::chrono::seconds{60};  // so long would who waits for them wait
  const Studio studio(options);
  const Place place(studio.address());
  Connection listener(place.port);
  ASSERT_TRUE(told_of_a_refined_design(place, listener));
  const double before = resident();
  constexpr int kClients = 200, kSeconds = 6;
  std::vector<std::unique_ptr<Connection>> slow;
  const auto arrive = [&] {
    slow.push_back(std::make_unique<Connection>(place.port));
    slow.back()->send("GET " + place.root + "state HTTP/1.1\r\nHost: " + place.host() + "\r\nX: ");
  };
  const auto first = std::chrono::steady_clock::now();
  for (int i = 0; i < kClients; ++i) arrive();
  // Nobody finds the queue full: who does, knocks again a second later.
  EXPECT_LT(std::chrono::steady_clock::now() - first, std::chrono::seconds{5});
  for (int second = 0; second < kSeconds; ++second) {
    for (auto& client : slow) client->send("a");
    const auto begin = std::chrono::steady_clock::now();
    const std::string set =
        fmt::format(R"({{"path":"drive.amplitude","value":"{} V"}})", 100 + second);
    EXPECT_EQ(replied(place, place.own("GET", "page/studio.css")).status, 200) << second << " s";
    EXPECT_EQ(replied(place, place.own("POST", "set", set)).status, 200) << second << " s";
    // Those who were sent away come back.
    std::erase_if(slow, [](auto& client) {
      client->read_until("never", 0.001);
      return client->closed();
    });
    while (slow.size() < kClients) arrive();
    std::this_thread::sleep_until(begin + std::chrono::seconds{1});
  }
  const std::string told = R"("value":"105 V")";
  EXPECT_NE(listener.read_until(told, 20).find(told), std::string::npos);
  EXPECT_LT(resident() - before, 100);
}

// A head without an end is cut; what sockets hold on the way is some megabytes.
TEST(SlowClients, CannotSendAHeadWithoutEnd) {
  const TemporaryFolder folder;
  const Studio studio(quick_studio(folder.path()));
  const Place place(studio.address());
  Connection endless(place.port);
  endless.send("GET " + place.root + "state HTTP/1.1\r\nHost: " + place.host() + "\r\n");
  const std::string lines = "X-Y: " + std::string(1000, 'z') + "\r\n";
  const auto begin = std::chrono::steady_clock::now();
  int sent = 0;
  while (sent < 100000 && endless.send(lines)) ++sent;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(sent, 20000);
  EXPECT_LT(took.count(), 5);
  EXPECT_EQ(replied(place, place.own("GET", "state")).status, 200);
}

// Requests of seeded hostility: paths that lead out, bodies that are none, methods, lengths that
// lie.
class Attacker {
 public:
  Attacker(const Place& place, unsigned seed) : place_(place), random_(seed) {}

  std::string request() {
    const std::string path =
        pick({place_.root, place_.root, place_.root, "/", "/0/", place_.root + "../"}) +
        pick({"set", "open", "save", "scan?name=" + name(), "scan/view", "scan/use", "export",
              "report/" + name(), "search/pick", "search/pause", "pin", "unpin", "take", "undo",
              "kind", "maps", "page/" + name(), "", name()});
    const std::string method =
        pick({"POST", "POST", "POST", "GET", "PUT", "DELETE", "OPTIONS", "G\rT", ""});
    std::string body =
        pick({"", "{", "[]", "null", "{\"name\":\"" + name() + "\",\"overwrite\":true}",
              "{\"path\":\"" + key() + "\",\"value\":\"" + name() + "\"}", "{\"pin\":1e99}",
              "{\"humidity\":\"x\"}", "{\"evaluation\":-1}", "{\"front\":\"" + name() + "\"}",
              std::string(3000, '['), noise()});
    std::string out = place_.request(
        method, path, body, pick({"http://" + place_.host(), "http://" + place_.host(), "null"}));
    if (chance(0.05)) out.replace(out.find("Content-Length: "), 17, "Content-Length: 9");
    if (chance(0.05)) out = out.substr(0, random_() % out.size());
    if (chance(0.03)) out = noise();
    return out;
  }

 private:
  bool chance(double share) { return std::uniform_real_distribution<double>()(random_) < share; }
  std::string pick(std::vector<std::string> from) { return from[random_() % from.size()]; }
  std::string key() {
    return pick({"texture.depth", "base", "finger.skin.map", "texture.type", "title", noise()});
  }
  std::string name() {
    return pick({"../outside.toml", "..%2f..%2foutside.toml", "/etc/passwd", "....//x.toml",
                 "a/../../b.toml", "%00.toml", "link/x.toml", ".studio/session.json", "x.gsf",
                 "-1 nm", "1e400 nm", "nan", "\\u0000"});
  }
  std::string noise() {
    std::string out;
    for (unsigned n = random_() % 64; n > 0; --n) out += static_cast<char>(1 + random_() % 255);
    std::erase(out, '"');
    std::erase(out, '\\');
    return out;
  }

  const Place& place_;
  std::mt19937 random_;
};

// PAPILLA_HOSTILE: how many; 10^5 takes minutes.
TEST(HostileRequests, NeitherEndTheStudioNorTouchWhatIsOutside) {
  const TemporaryFolder outside;
  const fs::path folder = outside.path() / "folder";
  fs::create_directories(folder);
  fs::create_symlink(outside.path(), folder / "link");
  write_bytes(outside.path() / "outside.toml", "schema_version = 1\n");
  const Studio studio(quick_studio(folder));
  const Place place(studio.address());
  const char* wanted = std::getenv("PAPILLA_HOSTILE");
  const int count = wanted ? std::atoi(wanted) : cases(2500, 10000);
  const auto before = fs::file_time_type::clock::now();
  Attacker attacker(place, 26);
  EXPECT_EQ(replied(place, place.own("GET", "state")).status, 200);
  {
    Connection listener(place.port);
    ASSERT_TRUE(told_of_a_refined_design(place, listener));
  }
  const double memory = resident();
  for (int i = 0; i < count; ++i) {
    Connection connection(place.port);
    ASSERT_TRUE(connection.open()) << "after " << i;
    connection.send(attacker.request());
    connection.read_until("\r\n\r\n", 0.02);
  }
  EXPECT_EQ(replied(place, place.own("GET", "state")).status, 200);
  EXPECT_LT(resident() - memory, 200);
  for (const auto& entry : fs::directory_iterator(outside.path())) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name == "folder" || name == "outside.toml") << name;
  }
  EXPECT_EQ(read_bytes(outside.path() / "outside.toml"), "schema_version = 1\n");
  EXPECT_LT(fs::last_write_time(outside.path() / "outside.toml"), before);
}

}  // namespace
}  // namespace papilla::tests::hostile_slow_test
