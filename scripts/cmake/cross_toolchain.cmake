# Toolchain of Debian's cross compilers, run by qemu-user.
#
#   RLPC_TRIPLET      aarch64-linux-gnu, arm-linux-gnueabihf, riscv64-linux-gnu, s390x-linux-gnu
#   RLPC_QEMU         qemu-aarch64, qemu-arm, qemu-riscv64, qemu-s390x
#   RLPC_TARGET_ROOT  folder with the target's zlib (and GoogleTest): include/, lib/
#
# Debian's cross compilers search /usr/include after the headers of the target, which is where
# the header-only libraries are.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES RLPC_TRIPLET RLPC_QEMU RLPC_TARGET_ROOT)
string(REGEX MATCH "^[^-]+" CMAKE_SYSTEM_PROCESSOR "${RLPC_TRIPLET}")
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_C_COMPILER ${RLPC_TRIPLET}-gcc)
set(CMAKE_CXX_COMPILER ${RLPC_TRIPLET}-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR ${RLPC_QEMU} -L /usr/${RLPC_TRIPLET})
set(CMAKE_FIND_ROOT_PATH ${RLPC_TARGET_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
