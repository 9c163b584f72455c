"""Tables of a case as objects: typed attributes over an ordered dictionary.

A `Table` holds the keys that were given, in their order, and nothing else. Reading a key that was not given returns its
default. Inner tables are created on access and join their table with their first key.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Iterator, Mapping, MutableMapping, MutableSequence
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar, cast, overload

from ._html import document

if TYPE_CHECKING:
    from typing_extensions import Self

G = TypeVar("G")
S = TypeVar("S")
T = TypeVar("T", bound="Table")


REFERRED = ("material", "primary")
"""Keys with the name of a thing, for which the thing itself may stand."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A remark with the closest known word, or the list of them where it is short."""
    known = list(known)
    close = difflib.get_close_matches(word, known, 1, 0.6)
    if close:
        return f"; did you mean {close[0]!r}?"
    if not known:
        return ""
    more = ", …" if len(known) > 12 else ""
    return f"; known: {', '.join(known[:12])}{more}"


def plain(value: Any) -> Any:
    """A value as TOML has it: arrays and tuples as lists, numpy's scalars as numbers, paths as text."""
    if isinstance(value, (str, bool, int, float, Table)):
        # subclasses of float such as numpy.float64 print differently
        return float(value) if isinstance(value, float) else value
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (list, tuple, range)):
        return [plain(one) for one in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in cast("Mapping[Any, Any]", value).items()}
    if hasattr(value, "__fspath__"):
        return str(value)
    return value


class Key(Generic[G, S]):
    """A key of a table with its meaning, what it takes and its default."""

    def __init__(self, doc: str, values: str = "", *, default: Any = None, key: str = "") -> None:
        self.doc = doc
        self.values = values
        self.default = default
        self.key = key
        self.name = key
        self.path = key

    def __set_name__(self, owner: type[Table], name: str) -> None:
        self.name = name
        self.key = self.key or name
        toml = owner.__dict__.get("_toml", "")
        self.path = f"{toml}.{self.key}" if toml else self.key
        default = "" if self.default is None else f"; default {self.default!r}"
        self.__doc__ = f"{self.doc}.\n\nTakes {self.values or 'anything'}{default}. TOML: `{self.path}`."

    @overload
    def __get__(self, table: None, owner: type[Any]) -> Self: ...
    @overload
    def __get__(self, table: Table, owner: type[Any]) -> G: ...
    def __get__(self, table: Table | None, owner: type[Any]) -> Any:
        if table is None:
            return self
        return self.read(table)

    def __set__(self, table: Table, value: S) -> None:
        self.write(table, value)

    def __delete__(self, table: Table) -> None:
        table._drop(self.key)

    def read(self, table: Table) -> Any:
        """The value of a table, or the default."""
        return table._values.get(self.key, self.default)

    def write(self, table: Table, value: Any) -> None:
        """Sets the value; `None` removes the key."""
        if value is None:
            table._drop(self.key)
        else:
            table._put(self.key, self.convert(value))

    def convert(self, value: Any) -> Any:
        """The value as it is stored."""
        return plain(value)


class _Inner(Key[G, S]):
    """A key whose values are tables of a class."""

    def __init__(self, table: type[Any], doc: str, values: str = "", *, default: Any = None, key: str = "") -> None:
        super().__init__(doc, values, default=default, key=key)
        self.table = table

    def read(self, table: Table) -> Any:
        """The value of a table; an inner table or list is created where there is none."""
        value = table._values.get(self.key)
        return table._child(self.key, self.create) if value is None else value

    def create(self) -> Any:
        """An empty one."""
        return self.table.made_from({})


def _converted(table: type[Table], value: Any) -> Any:
    if isinstance(value, Shape) and not isinstance(value, table):
        return table.made_from({type(value)._toml.rpartition(".")[2]: value})
    if isinstance(value, Mapping):
        return table.made_from(cast("Mapping[str, Any]", value))
    return plain(value)


class One(_Inner["T", "T | Mapping[str, Any]"], Generic[T]):
    """A key with a table."""

    if TYPE_CHECKING:

        def __init__(
            self, table: type[T], doc: str, values: str = "", *, default: Any = None, key: str = ""
        ) -> None: ...

    def convert(self, value: Any) -> Any:
        """Mappings become tables, and a shape the table that names it; other objects stay."""
        return _converted(self.table, value)


class Mixed(_Inner[Any, Any], Generic[T]):
    """A key with a table or something else: a number, a word."""

    if TYPE_CHECKING:

        def __init__(
            self, table: type[T], doc: str, values: str = "", *, default: Any = None, key: str = ""
        ) -> None: ...

    def convert(self, value: Any) -> Any:
        """Mappings become tables; rows of a motion over time its table; other objects stay."""
        value = _converted(self.table, value)
        if isinstance(value, list) and "table" in self.table._keys:
            return self.table.made_from({"table": cast("list[Any]", value)})
        return cast("Any", value)


class Items(_Inner["TableList[T]", "Iterable[T | Mapping[str, Any]]"], Generic[T]):
    """A key with a list of tables."""

    if TYPE_CHECKING:

        def __init__(
            self, table: type[T], doc: str, values: str = "", *, default: Any = None, key: str = ""
        ) -> None: ...

    def create(self) -> Any:
        """An empty list."""
        return TableList(self.table)

    def convert(self, value: Any) -> Any:
        """Any iterable of tables or mappings."""
        if isinstance(value, Mapping) or not isinstance(value, Iterable):
            raise TypeError(f"`{self.path}` takes a list of tables")
        return TableList(self.table, cast("Iterable[Any]", value), keep=True)


class Named(_Inner["TableDict[T]", "Mapping[str, T | Mapping[str, Any]]"], Generic[T]):
    """A key with tables by names of the user's choice."""

    if TYPE_CHECKING:

        def __init__(
            self, table: type[T], doc: str, values: str = "", *, default: Any = None, key: str = ""
        ) -> None: ...

    def create(self) -> Any:
        """No tables."""
        return TableDict(self.table)

    def convert(self, value: Any) -> Any:
        """Any mapping of names to tables or mappings."""
        if not isinstance(value, Mapping):
            raise TypeError(f"`{self.path}` takes tables by name")
        return TableDict(self.table, cast("Mapping[str, Any]", value))


class Table:
    """A table of a case. Its keys are attributes; nested ones are created on access.

    >>> from signorini.keys import Solver
    >>> solver = Solver()
    >>> solver.newton.max_iterations = 20
    >>> solver
    Solver(newton=SolverNewton(max_iterations=20))
    """

    _toml: ClassVar[str] = ""
    _implied: ClassVar[tuple[str, ...]] = ()
    _keys: ClassVar[dict[str, Key[Any, Any]]] = {}
    _attributes: ClassVar[dict[str, Key[Any, Any]]] = {}
    _values: dict[str, Any]
    _children: dict[str, Any]
    _parent: tuple[Table, str] | None

    def __init_subclass__(cls) -> None:
        own = [cast("Key[Any, Any]", one) for one in cls.__dict__.values() if isinstance(one, Key)]
        cls._keys = {**cls._keys, **{one.key: one for one in own}}
        cls._attributes = {**cls._attributes, **{one.name: one for one in own}}

    def __init__(self, values: Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        object.__setattr__(self, "_values", {})
        object.__setattr__(self, "_children", {})
        object.__setattr__(self, "_parent", None)
        self.update(values, **keys)

    @classmethod
    def made_from(cls, values: Mapping[str, Any]) -> Table:
        """A table of this class with these keys."""
        made = cls.__new__(cls)
        Table.__init__(made, values)
        return made

    def update(self, values: Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        """Sets several keys, by their TOML key or attribute name."""
        for name, value in {**(values or {}), **keys}.items():
            self[name] = value

    @classmethod
    def _find(cls, name: str) -> Key[Any, Any]:
        found = cls._keys.get(name) or cls._attributes.get(name)
        if found is None:
            raise AttributeError(cls._unknown(name))
        return found

    @classmethod
    def _unknown(cls, name: str) -> str:
        return f"{cls.__name__} has no key {name!r}{did_you_mean(name, [*cls._attributes, *cls._keys])}"

    def _put(self, key: str, value: Any) -> None:
        self._values[key] = value
        self._children.pop(key, None)
        self._join()

    def _drop(self, key: str) -> None:
        self._values.pop(key, None)
        self._children.pop(key, None)

    def _join(self) -> None:
        """Stores this table in the one it was created by."""
        if self._parent is not None:
            (parent, key), self._parent = self._parent, None
            if parent._children.get(key) is self:
                parent._put(key, self)

    def _child(self, key: str, create: Callable[[], Any]) -> Any:
        child = self._children.get(key)
        if child is None:
            child = create()
            child._parent = (self, key)
            self._children[key] = child
        return child

    def __setattr__(self, name: str, value: Any) -> None:
        found = getattr(type(self), name, None)
        if name.startswith("_") or isinstance(found, Key):
            object.__setattr__(self, name, value)
        elif callable(found):
            raise AttributeError(f"{name} of {type(self).__name__} is a method: call it, or assign to its list")
        else:
            raise AttributeError(self._unknown(name))

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            raise AttributeError(self._unknown(name))

    def __getitem__(self, key: str) -> Any:
        """The value of a key that was given."""
        return self._values[self._find(key).key]

    def __setitem__(self, key: str, value: Any) -> None:
        self._find(key).write(self, value)

    def __delitem__(self, key: str) -> None:
        del self._values[self._find(key).key]

    def __contains__(self, key: object) -> bool:
        found = self._keys.get(str(key)) or self._attributes.get(str(key))
        return found is not None and found.key in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __bool__(self) -> bool:
        return True

    def to_dict(self) -> dict[str, Any]:
        """The keys that were given, with their values, as TOML has them."""
        return dump(self)

    def to_dict_raw(self) -> dict[str, Any]:
        """The keys that were given; objects of Python stay."""
        return dump(self, lambda value, key, table: value)

    def copy(self) -> Self:
        """A copy; meshes and own physics are shared."""
        twin = type(self).__new__(type(self))
        object.__setattr__(twin, "_values", {})
        object.__setattr__(twin, "_children", {})
        object.__setattr__(twin, "_parent", None)
        for key, value in self._values.items():
            twin._values[key] = _copied(value)
        return twin

    __copy__ = copy

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table) or self._keys.keys() != other._keys.keys():
            return NotImplemented
        return self.to_dict_raw() == other.to_dict_raw()

    __hash__ = None  # type: ignore[assignment]  # pyright: ignore[reportAssignmentType]

    def __repr__(self) -> str:
        given = [f"{self._keys[key].name}={value!r}" for key, value in self._values.items() if key not in self._implied]
        return f"{type(self).__name__}({', '.join(given)})"

    def _repr_html_(self) -> str:
        rows = [(key, _short(value), self._keys[key].doc) for key, value in self._values.items()]
        return document(type(self).__name__, rows, ("key", "value", "meaning"))


class Shape(Table):
    """A shape of a rigid surface: what `[[surface]] shape` holds."""


class MaterialTable(Table):
    """A material. Its class says the model."""

    _model: ClassVar[str] = ""
    _models: ClassVar[dict[str, type[MaterialTable]]] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if cls._model:
            cls._implied = ("model",)
            MaterialTable._models[cls._model] = cls

    def __init__(self, values: Mapping[str, Any] | None = None, /, **keys: Any) -> None:
        model = {"model": self._model} if self._model else {}
        super().__init__({**model, **(values or {})}, **keys)

    @classmethod
    def made_from(cls, values: Mapping[str, Any]) -> MaterialTable:
        """A material of the class of its model."""
        table = cls._models.get(str(values.get("model", "")), cls)
        made = table.__new__(table)
        Table.__init__(made, values)
        return made


class TableList(MutableSequence[T]):
    """A list of tables, by index or by name.

    >>> from signorini.keys import CaseTable
    >>> case = CaseTable(contact=[{"name": "foot", "secondary": "a", "primary": "b"}])
    >>> case.contacts["foot"] is case.contacts[0]
    True
    """

    def __init__(self, table: type[T], values: Iterable[T | Mapping[str, Any]] = (), *, keep: bool = False) -> None:
        self._table = table
        self._parent: tuple[Table, str] | None = None
        self._is_kept = keep
        self._list: list[T] = [self._convert(value) for value in values]

    def _convert(self, value: T | Mapping[str, Any]) -> T:
        if isinstance(value, Mapping):
            return cast("T", self._table.made_from(value))
        if isinstance(value, self._table):
            return value
        raise TypeError(f"a {self._table.__name__} is needed, found {type(value).__name__}")

    def _join(self) -> None:
        _join_list(self)

    def names(self) -> list[str]:
        """The names of the tables: what `name` says, or the group, set or column they are about."""
        return [_name(one) for one in self._list]

    def _index(self, which: int | str) -> int:
        if isinstance(which, int):
            return which
        for index, one in enumerate(self._list):
            if _is_called(one, which):
                return index
        raise KeyError(f"no {self._table.__name__.lower()} is called {which!r}{did_you_mean(which, self.names())}")

    @overload
    def __getitem__(self, index: int | str) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...  # pyright: ignore[reportIncompatibleMethodOverride]
    def __getitem__(self, index: int | str | slice) -> T | list[T]:
        if isinstance(index, slice):
            return self._list[index]
        return self._list[self._index(index)]

    def __setitem__(self, index: int | str, value: T | Mapping[str, Any]) -> None:  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        self._list[self._index(index)] = self._convert(value)

    def __delitem__(self, index: int | str | slice) -> None:
        if isinstance(index, slice):
            del self._list[index]
        else:
            del self._list[self._index(index)]

    def __contains__(self, item: object) -> bool:
        if isinstance(item, str):
            return any(_is_called(one, item) for one in self._list)
        return any(one is item or one == item for one in self._list)

    def __len__(self) -> int:
        return len(self._list)

    def insert(self, index: int, value: T | Mapping[str, Any]) -> None:
        """Inserts a table or a mapping with its keys."""
        self._list.insert(index, self._convert(value))
        self._join()

    def add(self, value: T) -> T:
        """Appends a table and returns it."""
        self.append(value)
        return value

    def __eq__(self, other: object) -> bool:
        if isinstance(other, (TableList, list)):
            mine, others = list(self), list(cast("Iterable[Any]", other))
            return mine == others or dump(self) == others
        return NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(self._list)

    def _repr_html_(self) -> str:
        rows = [(_name(one), _short(one)) for one in self._list]
        return document(f"{self._table.__name__}s", rows, ("name", "keys"))


class TableDict(MutableMapping[str, T]):
    """Tables by name, or by index in their order."""

    def __init__(self, table: type[T], values: Mapping[str, T | Mapping[str, Any]] | None = None) -> None:
        self._table = table
        self._parent: tuple[Table, str] | None = None
        self._is_kept = False
        self._dict: dict[str, T] = {name: self._convert(value) for name, value in (values or {}).items()}

    def _convert(self, value: T | Mapping[str, Any]) -> T:
        if isinstance(value, Mapping):
            return cast("T", self._table.made_from(value))
        if isinstance(value, self._table):
            return value
        own = getattr(value, "as_table", None)
        if own is not None:
            return self._convert(own())
        raise TypeError(f"a {self._table.__name__} is needed, found {type(value).__name__}")

    def _join(self) -> None:
        _join_list(self)

    def _key(self, which: int | str) -> str:
        if isinstance(which, int):
            return list(self._dict)[which]
        if which in self._dict:
            return which
        raise KeyError(f"no {self._table.__name__.lower()} is called {which!r}{did_you_mean(which, self._dict)}")

    def __getitem__(self, key: int | str) -> T:
        return self._dict[self._key(key)]

    def __setitem__(self, key: str, value: T | Mapping[str, Any]) -> None:
        self._dict[key] = self._convert(value)
        self._join()

    def __delitem__(self, key: int | str) -> None:
        del self._dict[self._key(key)]

    def __contains__(self, key: object) -> bool:
        return key in self._dict

    def __iter__(self) -> Iterator[str]:
        return iter(self._dict)

    def __len__(self) -> int:
        return len(self._dict)

    def names(self) -> list[str]:
        """The names in their order."""
        return list(self._dict)

    def __repr__(self) -> str:
        return repr(self._dict)

    def _repr_html_(self) -> str:
        rows = [(name, _short(one)) for name, one in self._dict.items()]
        return document(f"{self._table.__name__}s", rows, ("name", "keys"))


def dump(value: Any, leaf: Callable[[Any, str, Table | None], Any] | None = None) -> Any:
    """Tables and lists of them as dictionaries and lists.

    `leaf` receives what TOML does not have, with the key and the table it stands in.
    """

    def walk(value: Any, key: str, table: Table | None) -> Any:
        if leaf is not None and key in REFERRED and isinstance(value, (MaterialTable, Shape)):
            return leaf(value, key, table)
        if isinstance(value, Table):
            out: dict[str, Any] = {}
            for name, below in value._values.items():
                if is_given(below):
                    out[name] = walk(below, name, value)
            return out
        if isinstance(value, TableList):
            return [walk(one, key, table) for one in cast("TableList[Any]", value)]
        if isinstance(value, TableDict):
            return {name: walk(one, "", table) for name, one in cast("TableDict[Any]", value).items()}
        if isinstance(value, list):
            return [walk(one, key, table) for one in cast("list[Any]", value)]
        if leaf is not None and not isinstance(value, (str, bool, int, float)):
            return leaf(value, key, table)
        return value

    return walk(value, "", None)


def is_given(value: Any) -> bool:
    """Whether a value is written: empty lists are where they were assigned."""
    if isinstance(value, (TableList, TableDict)):
        return len(cast("Any", value)) > 0 or value._is_kept  # pyright: ignore[reportUnknownMemberType]
    return True


def _join_list(tables: Any) -> None:
    """Stores a list of tables in the table it was created by."""
    if tables._parent is not None:
        (parent, key), tables._parent = tables._parent, None
        if parent._children.get(key) is tables:
            parent._put(key, tables)


def _copied(value: Any) -> Any:
    if isinstance(value, Table):
        return value.copy()
    if isinstance(value, TableList):
        values = cast("TableList[Any]", value)
        return TableList(values._table, [one.copy() for one in values], keep=values._is_kept)
    if isinstance(value, TableDict):
        tables = cast("TableDict[Any]", value)
        return TableDict(tables._table, {name: one.copy() for name, one in tables.items()})
    if isinstance(value, list):
        return [_copied(one) for one in cast("list[Any]", value)]
    return value


def _name(table: Table) -> str:
    for key in ("name", "group", "set", "on", "what", "kind"):
        value = table._values.get(key)
        if value is not None:
            return ", ".join(cast("list[str]", value)) if isinstance(value, list) else str(value)
    return ""


def _is_called(table: Table, name: str) -> bool:
    for key in ("name", "group", "set", "on", "what"):
        value = table._values.get(key)
        if value is not None:
            return name in value if isinstance(value, list) else value == name
    return False


def _short(value: Any, most: int = 120) -> str:
    text = repr(value)
    return text if len(text) <= most else text[: most - 1] + "…"
