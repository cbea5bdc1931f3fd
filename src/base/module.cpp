#include "base/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

#include "base/installation.h"

namespace papilla::base {
namespace {

std::string file_of(const std::string& name) {
  return find_module("papilla_" + name + ".so").string();
}

void* opened(const std::string& file) { return dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL); }

}  // namespace

const void* load_module(const std::string& name, int version, const std::string& purpose) {
  using Entry = const void* (*)(int);
  const std::string file = file_of(name);
  void* module = opened(file);
  void* entry = module ? dlsym(module, ("papilla_" + name).c_str()) : nullptr;
  if (!entry) {
    throw std::runtime_error("cannot " + purpose + ": " + dlerror() +
                             "; build or install Papilla anew: the module belongs to it");
  }
  const void* implementation = reinterpret_cast<Entry>(entry)(version);
  if (!implementation) {
    throw std::runtime_error("cannot " + purpose + ": " + file +
                             " is of another version; build or install Papilla anew");
  }
  return implementation;
}

bool module_loads(const std::string& name) { return opened(file_of(name)) != nullptr; }

}  // namespace papilla::base
