/*
 * What the Windows binary takes of a compiler's own library: the function that touches each page of a large frame, in
 * order, so that the system makes the stack longer. %rax is the frame's size; no register changes. ziglang's library
 * has it too, but is linked whole: 30 kB of the compressed FMU. Other compilers bring their own: not among the sources.
 */
__asm__(
    ".globl ___chkstk_ms\n"
    "___chkstk_ms:\n"
    "    pushq %rcx\n"
    "    pushq %rax\n"
    "    leaq 24(%rsp), %rcx\n" /* the caller's stack pointer */
    "1:  cmpq $4096, %rax\n"
    "    jbe 2f\n"
    "    subq $4096, %rcx\n"
    "    orb $0, (%rcx)\n"
    "    subq $4096, %rax\n"
    "    jmp 1b\n"
    "2:  subq %rax, %rcx\n"
    "    orb $0, (%rcx)\n"
    "    popq %rax\n"
    "    popq %rcx\n"
    "    ret\n");
