#include "report/pdf.h"

#include <unistd.h>

#include <filesystem>
#include <vector>

#include "base/bounded_child.h"
#include "base/error.h"
#include "base/files.h"
#include "base/scratch_folder.h"

namespace papilla::report {

std::string page_as_pdf(const std::string& html) {
  const std::string program = program_on_path({"chromium", "chromium-browser", "google-chrome"});
  if (program.empty())
    throw InputError(
        "a PDF is printed by Chromium, which is not installed here (apt install chromium); print "
        "the page from another browser");
  const ScratchFolder scratch("pdf");
  const std::string page = scratch.file("page.html"), out = scratch.file("page.pdf");
  write_bytes(page, html);
  std::vector<std::string> words{program, "--headless", "--disable-gpu", "--no-first-run",
                                 "--no-pdf-header-footer", "--print-to-pdf-no-header",
                                 // The page asks nothing of the network, and gets nothing.
                                 "--host-resolver-rules=MAP * ~NOTFOUND",
                                 "--user-data-dir=" + scratch.file("profile"),
                                 // Its charts are drawn, in their own time, before it is printed.
                                 "--virtual-time-budget=10000", "--print-to-pdf=" + out};
  if (::geteuid() == 0) words.emplace_back("--no-sandbox");  // which root cannot have
  words.push_back("file://" + page);
  const ChildEnd end = run_bounded(
      std::move(words),
      {"HOME=" + scratch.file(""), "PATH=/usr/bin:/bin", "TMPDIR=" + scratch.file("")}, {});
  std::error_code missing;
  if (end != ChildEnd::Done || !std::filesystem::exists(out, missing))
    throw InputError(end == ChildEnd::TooLong ? "Chromium took longer than 60 s and was ended"
                                              : "Chromium did not print the page");
  return read_bytes(out);
}

}  // namespace papilla::report
