// Memory for programs that run once.
#pragma once

namespace freiform {

// For a program to call where it begins: lets its heap grow in large pages, where system and allocator
// (Linux, glibc) can. Such a program touches nearly all of its memory for the first time, and pays for every
// page: with small ones that is up to half of the time of a tessellation on virtual machines. What is freed
// stays with the process. Does nothing where addresses are limited to less than 2 GiB.
void use_large_pages();

}  // namespace freiform
