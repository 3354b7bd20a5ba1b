"""What Dr.Jit spent on compiling kernels. Needs its flag KernelHistory."""

import drjit as dr


def compile_seconds():
    """Seconds of code generation and compilation since the history was cleared last; clears it."""
    return sum((kernel.get("codegen_time") or 0) + (kernel.get("backend_time") or 0)
               for kernel in dr.kernel_history()) / 1000
