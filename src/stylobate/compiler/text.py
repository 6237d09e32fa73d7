"""Text of LLVM functions and modules."""

from dataclasses import dataclass, field


@dataclass(slots=True, eq=False)
class BasicBlock:
    """Basic block: instructions in sequence; the last one jumps or returns.

    `assigned` are the names that have a value on every path to the present instruction of the block.
    """

    label: str
    lines: list[str] = field(default_factory=list)
    ended: bool = False
    reached: bool = False
    assigned: set[str] = field(default_factory=set)


class FunctionText:
    """Text of a function under construction; instructions are added to the last block that was begun."""

    def __init__(self) -> None:
        self._count = 0
        self._allocations: list[str] = []
        self._blocks = [BasicBlock("begin", reached=True)]
        self.block = self._blocks[0]

    def name(self) -> str:
        """Return a new name."""
        self._count += 1
        return f"%v{self._count}"

    def line(self, text: str) -> None:
        """Add an instruction without a result."""
        self.block.lines.append(text)

    def value(self, text: str) -> str:
        """Add an instruction and return the name of its result."""
        name = self.name()
        self.block.lines.append(f"{name} = {text}")
        return name

    def allocated(self, kind: str) -> str:
        """Return a pointer to memory for a value of this type, with the lifetime of the function call."""
        name = self.name()
        self._allocations.append(f"{name} = alloca {kind}")
        return name

    def new_block(self) -> BasicBlock:
        """Return a new block for branches; `begin` appends it to the function."""
        self._count += 1
        return BasicBlock(f"b{self._count}")

    def begin(self, block: BasicBlock) -> None:
        """Make this the current block; an unreachable block counts as ended."""
        self._blocks.append(block)
        self.block = block
        block.ended = not block.reached

    def jump(self, block: BasicBlock) -> None:
        """Jump to a block, unless the current block has ended."""
        self.reach(block)
        self.end(f"br label %{block.label}")

    def branch(self, condition: str, yes: BasicBlock, no: BasicBlock) -> None:
        """Branch to one of two blocks."""
        self.reach(yes)
        self.reach(no)
        self.end(f"br i1 {condition}, label %{yes.label}, label %{no.label}")

    def reach(self, block: BasicBlock) -> None:
        """Note that the current block, unless it has ended, leads to another one."""
        if not self.block.ended:
            block.assigned = block.assigned & self.block.assigned if block.reached else set(self.block.assigned)
            block.reached = True

    def end(self, line: str) -> None:
        """End the block with this instruction, unless it has ended."""
        if not self.block.ended:
            self.block.lines.append(line)
            self.block.ended = True

    def body(self) -> str:
        """Return the text between the braces."""
        out = ["entry:", *(f"  {line}" for line in self._allocations), f"  br label %{self._blocks[0].label}"]
        for block in self._blocks:
            out.append(f"{block.label}:")
            out += [f"  {line}" for line in block.lines]
            if not (block.ended and block.reached):
                out.append("  unreachable")
        return "\n".join(out)


class ModuleText:
    """Text of a module under construction."""

    def __init__(self) -> None:
        self._declared: dict[str, str] = {}
        self._constants: dict[tuple[str, ...], str] = {}
        self._functions: list[str] = []

    def declared(self, name: str, result: str, arguments: list[str]) -> str:
        """Declare an external function; return its name."""
        self._declared[name] = f"declare {result} @{name}({', '.join(arguments)})"
        return f"@{name}"

    def table(self, numbers: list[str]) -> str:
        """Return a pointer to a constant row of numbers, which are texts with their type."""
        key = tuple(numbers)
        if key not in self._constants:
            self._constants[key] = f"@table{len(self._constants)}"
        return self._constants[key]

    def define(self, head: str, body: str) -> None:
        """Add a function."""
        self._functions.append(f"define {head} #0 {{\n{body}\n}}")

    def text(self, attributes: str) -> str:
        """Return the text of the module, with these attributes of its functions."""
        tables = (
            f"{name} = internal unnamed_addr constant [{len(numbers)} x double] [{', '.join(numbers)}]"
            for numbers, name in self._constants.items()
        )
        parts = [*tables, *self._declared.values(), *self._functions, f"attributes #0 = {{ {attributes} }}"]
        return "\n\n".join(parts) + "\n"
