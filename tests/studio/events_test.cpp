// What pages are told, and in which order.
#include "studio/events.h"

#include <gtest/gtest.h>

namespace papilla::tests::events_test {
namespace {

using std::chrono::milliseconds;

TEST(Events, ComeInTheirOrderAndOnlyTheNewestOfATopic) {
  Events events;
  events.tell(Topic::Shape, "old");
  events.tell(Topic::Response, "curve");
  events.tell(Topic::Session, "form");
  events.tell(Topic::Shape, "new");
  std::uint64_t seen = 0;
  std::string told;
  for (const Message& m : events.since(seen, milliseconds(0))) told += m.text + " ";
  EXPECT_EQ(told, "curve form new ");
  EXPECT_TRUE(events.since(seen, milliseconds(0)).empty());
  events.tell(Topic::Response, "next");
  const auto news = events.since(seen, milliseconds(0));
  ASSERT_EQ(news.size(), 1u);
  EXPECT_EQ(news[0].text, "next");
}

TEST(Events, TellNothingAfterTheirEnd) {
  Events events;
  events.tell(Topic::Response, "curve");
  events.close();
  std::uint64_t seen = 0;
  EXPECT_TRUE(events.since(seen, milliseconds(60000)).empty());
}

}  // namespace
}  // namespace papilla::tests::events_test
