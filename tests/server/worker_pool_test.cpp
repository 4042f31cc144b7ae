#include "server/http/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <set>
#include <thread>
#include <vector>

namespace stagger::server {
namespace {

/// A pool of one thread, which item 0 holds until release().
class WorkerPoolTest : public ::testing::Test {
 protected:
  void hold() {
    pool_.add(0);
    begun_.get_future().wait();
  }
  void release() { gate_.set_value(); }

  std::promise<void> begun_;
  std::promise<void> gate_;
  std::vector<int> done_;  // by the one thread; looked at after the pool's end
  WorkerPool<int> pool_{{1, 1, 3}, [this](int item) {
                          done_.push_back(item);
                          if (item != 0) return;
                          begun_.set_value();
                          gate_.get_future().wait();
                        }};
};

TEST_F(WorkerPoolTest, ServesWhatIsAdded) {
  EXPECT_FALSE(pool_.add(1));
  pool_.stop();
  EXPECT_EQ(done_, std::vector<int>{1});
}

TEST_F(WorkerPoolTest, TheNewestIsServedFirst) {
  hold();
  for (int i = 1; i <= 3; ++i) EXPECT_FALSE(pool_.add(i));
  EXPECT_EQ(pool_.waiting(), 3U);
  release();
  pool_.stop();
  EXPECT_EQ(done_, (std::vector<int>{0, 3, 2, 1}));
}

TEST_F(WorkerPoolTest, TheOldestMakesRoom) {
  hold();
  for (int i = 1; i <= 3; ++i) EXPECT_FALSE(pool_.add(i));
  EXPECT_EQ(pool_.add(4), 1);
  release();
  pool_.stop();
  EXPECT_EQ(done_, (std::vector<int>{0, 4, 3, 2}));
}

TEST_F(WorkerPoolTest, WhoWantsMoreStandsBehindAllOthers) {
  hold();
  EXPECT_FALSE(pool_.add(1));
  EXPECT_FALSE(pool_.add_more(2));
  EXPECT_FALSE(pool_.add_more(3));
  EXPECT_FALSE(pool_.add(4));
  EXPECT_EQ(pool_.waiting(), 4U);
  release();
  pool_.stop();
  EXPECT_EQ(done_, (std::vector<int>{0, 4, 1, 2, 3}));
}

TEST_F(WorkerPoolTest, WhoWantsMoreMakesNobodyGo) {
  hold();
  for (int i = 1; i <= 3; ++i) EXPECT_FALSE(pool_.add_more(i));
  EXPECT_EQ(pool_.add_more(4), 4);
  EXPECT_FALSE(pool_.add(5)) << "has room of its own";
  release();
}

// Two threads, one of them for more: while that one is held, others are still served.
TEST(WorkerPool, WhoWantsMoreDoesNotGetAllThreads) {
  std::promise<void> begun;
  std::promise<void> gate;
  std::promise<void> served;
  std::atomic<int> more{0};
  WorkerPool<int> pool({2, 1, 10}, [&](int item) {
    if (item == 0) {
      begun.set_value();
      gate.get_future().wait();
    } else if (item == 1) {
      ++more;
    } else {
      served.set_value();
    }
  });
  pool.add_more(0);
  begun.get_future().wait();
  pool.add_more(1);
  pool.add(2);
  served.get_future().wait();
  EXPECT_EQ(more, 0);
  gate.set_value();
  pool.stop();
  EXPECT_EQ(more, 1);
}

// One at a time: each is done before the next one comes.
TEST(WorkerPool, FewThreadsDoWhatFewCanDo) {
  constexpr int items = 64;
  std::set<std::thread::id> threads;
  WorkerPool<std::promise<void>*> pool({items, 1, 1}, [&](std::promise<void>* done) {
    threads.insert(std::this_thread::get_id());
    done->set_value();
  });
  for (int i = 0; i < items; ++i) {
    std::promise<void> done;
    pool.add(&done);
    done.get_future().wait();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // it falls asleep
  }
  pool.stop();
  EXPECT_LT(threads.size(), items / 2) << "in turn it would be all of them";
}

TEST_F(WorkerPoolTest, AfterItsEndItTakesNothing) {
  pool_.stop();
  EXPECT_EQ(pool_.add(1), 1);
  EXPECT_TRUE(done_.empty());
}

}  // namespace
}  // namespace stagger::server
