// What every learner on libtorch does: it finds its device, keeps its state, agrees with other processes and
// takes steps of Adam.
#pragma once

#include <torch/torch.h>
#ifdef ODIS_GLOO
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#endif
#ifdef ODIS_NCCL
#include <torch/csrc/distributed/c10d/ProcessGroupNCCL.hpp>
#endif
#if defined(ODIS_GLOO) || defined(ODIS_NCCL)
#define ODIS_PROCESSES
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#endif

#include <cstdlib>
#include <cstring>
#include <sstream>

#include "learn/train/learner.h"

namespace odis::learn {

// Gradients longer than this are shortened.
inline constexpr double kLongestGradient = 1;

inline torch::Tensor toDevice(const std::vector<float>& values, at::IntArrayRef shape,
                              const torch::Device& device) {
  return torch::from_blob(const_cast<float*>(values.data()), shape, torch::kFloat32).to(device);
}

inline torch::Device chooseDevice(const std::string& name) {
  const bool cuda = torch::cuda::is_available();
  if (name == "cuda" && !cuda)
    throw TrainError("there is no CUDA device that libtorch can use, expected \"cpu\"");
  if (!cuda || name == "cpu") return torch::kCPU;
  // As torchrun numbers the processes of a machine.
  const char* local = std::getenv("LOCAL_RANK");
  const int index = local ? std::atoi(local) : 0;
  return {torch::kCUDA, torch::DeviceIndex(index % int(torch::cuda::device_count()))};
}

inline core::Tensor toTensor(const std::string& name, const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.detach().to(torch::kCPU, torch::kFloat32).contiguous();
  core::Tensor result{name, {}, {values.data_ptr<float>(), values.data_ptr<float>() + values.numel()}};
  for (const int64_t size : values.sizes()) result.shape.push_back(uint32_t(size));
  return result;
}

// A network and its optimizer, under a name of their own in a learner's state.
struct Trained {
  const char* name;
  torch::nn::Module& module;
  torch::optim::Adam& adam;

  std::string adamName() const { return std::string(name) + ".adam"; }
};

// All that their next steps depend on, as bytes.
inline std::string stateOf(const std::vector<Trained>& all) {
  torch::serialize::OutputArchive archive;
  for (const Trained& trained : all) {
    torch::serialize::OutputArchive module, adam;
    trained.module.save(module);
    trained.adam.save(adam);
    archive.write(trained.name, module);
    archive.write(trained.adamName(), adam);
  }
  std::ostringstream stream;
  archive.save_to(stream);
  return stream.str();
}

inline void restore(const std::vector<Trained>& all, const std::string& state, const torch::Device& device) {
  std::istringstream stream(state);
  torch::serialize::InputArchive archive;
  archive.load_from(stream, device);
  for (const Trained& trained : all) {
    torch::serialize::InputArchive module, adam;
    archive.read(trained.name, module);
    archive.read(trained.adamName(), adam);
    trained.module.load(module);
    trained.adam.load(adam);
  }
}

class TorchProcesses {
 public:
  TorchProcesses(const Processes& processes, const torch::Device& device)
      : m_device(device), m_processes(processes) {
    if (processes.count > 1) join();
  }

  // The text that the first process gives, for all.
  std::string agree(const std::string& text) {
    if (m_processes.count == 1) return text;
    torch::Tensor length = torch::tensor({int64_t(text.size())});
    broadcast(length);
    torch::Tensor bytes = torch::zeros({length.item<int64_t>()}, torch::kUInt8);
    if (m_processes.rank == 0) std::memcpy(bytes.data_ptr(), text.data(), text.size());
    if (bytes.numel() > 0) broadcast(bytes);
    return {static_cast<const char*>(bytes.data_ptr()), size_t(bytes.numel())};
  }

  // A step of the optimizer along the gradient of the loss, averaged over all processes; returns the loss.
  double descend(torch::nn::Module& module, torch::optim::Adam& adam, const torch::Tensor& loss,
                 double learningRate) {
    adam.zero_grad();
    loss.backward();
    double mean = loss.item<double>();
    if (m_processes.count > 1) average(module, mean);
    torch::nn::utils::clip_grad_norm_(module.parameters(), kLongestGradient);
    for (auto& group : adam.param_groups())
      static_cast<torch::optim::AdamOptions&>(group.options()).lr(learningRate);
    adam.step();
    return mean;
  }

  // The mean of a number over all processes.
  double mean(double value) {
    if (m_processes.count == 1) return value;
    std::vector<torch::Tensor> all{
        torch::full({1}, value, torch::TensorOptions(m_talksOn).dtype(torch::kFloat32))};
    sum(all);
    return all[0].item<double>() / m_processes.count;
  }

 private:
#ifdef ODIS_PROCESSES
  void join() {
    const char* address = std::getenv("MASTER_ADDR");
    const char* port = std::getenv("MASTER_PORT");
    if (!address || !port)
      throw TrainError("several processes need MASTER_ADDR and MASTER_PORT, as torchrun sets them");
    try {
      c10d::TCPStoreOptions options;
      options.port = uint16_t(std::atoi(port));
      options.isServer = m_processes.rank == 0;
      options.numWorkers = size_t(m_processes.count);
      m_group = makeGroup(c10::make_intrusive<c10d::TCPStore>(address, options));
    } catch (const c10::Error& e) {
      throw TrainError(std::string("the processes don't find each other: ") + e.what_without_backtrace());
    }
  }
  // What libtorch 2 calls a backend was a process group before.
#if TORCH_VERSION_MAJOR >= 2
  using Group = c10d::Backend;
#else
  using Group = c10d::ProcessGroup;
#endif
  // Processes on CUDA talk by NCCL where it is there, others by Gloo.
  c10::intrusive_ptr<Group> makeGroup(const c10::intrusive_ptr<c10d::Store>& store) {
#ifdef ODIS_NCCL
    if (m_device.is_cuda()) {
      m_talksOn = m_device;
      return c10::make_intrusive<c10d::ProcessGroupNCCL>(store, m_processes.rank, m_processes.count);
    }
#endif
#ifdef ODIS_GLOO
    const auto gloo = c10d::ProcessGroupGloo::Options::create();
    gloo->devices.push_back(c10d::ProcessGroupGloo::createDefaultDevice());
    return c10::make_intrusive<c10d::ProcessGroupGloo>(store, m_processes.rank, m_processes.count, gloo);
#else
    throw TrainError("this odis was built without Gloo: several processes need a CUDA device each");
#endif
  }
  // What the first process has, for all.
  void broadcast(torch::Tensor& tensor) {
    std::vector<torch::Tensor> there{tensor.to(m_talksOn)};
    m_group->broadcast(there)->wait();
    tensor = there[0].to(torch::kCPU);
  }
  void sum(std::vector<torch::Tensor>& tensors) {
    m_group->allreduce(tensors)->wait();
  }
  // Of all gradients at once, and the loss.
  void average(torch::nn::Module& module, double& loss) {
    std::vector<torch::Tensor> parts;
    for (const torch::Tensor& p : module.parameters()) parts.push_back(p.grad().reshape({-1}).to(m_talksOn));
    parts.push_back(torch::full({1}, loss, torch::TensorOptions(m_talksOn).dtype(torch::kFloat32)));
    std::vector<torch::Tensor> all{torch::cat(parts)};
    sum(all);
    const torch::Tensor mean = all[0] / double(m_processes.count);
    int64_t at = 0;
    for (torch::Tensor& p : module.parameters()) {
      p.mutable_grad().copy_(mean.slice(0, at, at + p.numel()).reshape(p.sizes()));
      at += p.numel();
    }
    loss = mean[at].item<double>();
  }
  c10::intrusive_ptr<Group> m_group;
#else
  void join() {
    throw TrainError("this odis was built without Gloo and NCCL: one process can train");
  }
  void broadcast(torch::Tensor&) {}
  void sum(std::vector<torch::Tensor>&) {}
  void average(torch::nn::Module&, double&) {}
#endif

  torch::Device m_device;
  torch::Device m_talksOn = torch::kCPU;  // where tensors are when processes exchange them
  Processes m_processes;
};

}  // namespace odis::learn
