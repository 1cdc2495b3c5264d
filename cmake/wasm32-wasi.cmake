# WebAssembly with Debian's clang-22, wasi-libc and libc++-22-dev-wasm32 (tools/setup.sh wasm).
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(triple wasm32-wasi)
set(CMAKE_CXX_COMPILER clang++-22)
set(CMAKE_CXX_COMPILER_TARGET ${triple})
# wasm-ld reads archives without an index, so the ar of the machine will do.
find_program(CMAKE_AR NAMES llvm-ar-22 llvm-ar ar)
find_program(CMAKE_RANLIB NAMES llvm-ranlib-22 llvm-ranlib ranlib)
# Programs are linked against a module without `main`; nothing has to be linked to test the compiler.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# Nothing asks for types at run time, and there is one thread: both only make the module larger.
set(CMAKE_CXX_FLAGS_INIT "-fno-exceptions -fno-rtti -fno-threadsafe-statics -msimd128 -Wno-deprecated")
# What wasm-opt does is said in bindings/wasm/CMakeLists.txt; what clang asks of it takes minutes and saves less.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-mexec-model=reactor -Wl,--strip-all --no-wasm-opt")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
