//! Files that are open: where their bytes are, and what was read from them.

use core::ffi::{CStr, c_char, c_int, c_void};

use subsurf_decoder::bssrdf::Bssrdf;
use subsurf_decoder::btf::{Catalog, ExpandedBtf};
use subsurf_decoder::{Content, File};

use crate::border;
use crate::failure::{Failure, SubsurfStatus, status_of};
use crate::handle::{Handle, Kind};
use crate::map::Mapping;
use crate::memory::Numbers;

/// Length that stands for all bytes from an offset to the end of the file.
pub const SUBSURF_TO_END: u64 = u64::MAX;

/// Checked `.subsurf` file of any family.
///
/// Ownership: `subsurf_file_open_*` give one, `subsurf_file_close` takes it back.
/// Threads: any number at once, but for `subsurf_btf_expand` and `subsurf_file_close`, which need the file for themselves.
pub struct SubsurfFile {
    /// What is there is a [`Handle`] of [`OpenFile`].
    _opaque: [u8; 0],
}

/// What is behind a handle.
pub struct OpenFile {
    file: File<'static>,
    /// Texels of a BTF.
    texels: u32,
    /// What `subsurf_btf_expand` made.
    expansion: Option<Expansion>,
    /// Bytes of the file; `None` where they are the caller's.
    _mapping: Option<Mapping>,
}

/// Expanded factored BTF, and the memory that it borrows.
pub(crate) struct Expansion {
    pub(crate) btf: ExpandedBtf<'static>,
    pub(crate) _table: Numbers<i8>,
    pub(crate) _words: Numbers<i16>,
}

impl Kind for OpenFile {
    const NAME: &'static str = "SubsurfFile";
    const WORD: u64 = 0x5ab5_0f11_e0be_0001;
}

impl SubsurfFile {
    /// The file behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    #[doc(hidden)]
    pub unsafe fn of<'f>(file: *const Self) -> Result<&'f OpenFile, Failure<'static>> {
        // SAFETY: the caller's word; what is there is such a handle.
        unsafe { Handle::of("file", file.cast()) }
    }

    /// Keeps an expansion.
    ///
    /// # Safety
    /// As [`Handle::of`] says, and nothing else uses the file meanwhile.
    pub(crate) unsafe fn expand(file: *mut Self, expansion: Expansion) -> Result<(), Failure<'static>> {
        // SAFETY: the caller's word; what is there is such a handle.
        unsafe { Handle::<OpenFile>::of_mut("file", file.cast()) }?.expansion = Some(expansion);
        Ok(())
    }
}

impl OpenFile {
    pub(crate) fn content(&self) -> Content<'static> {
        self.file.content()
    }

    /// The file, as long as its handle is open.
    pub fn file(&self) -> &File<'static> {
        &self.file
    }

    pub(crate) fn bssrdf(&self) -> Result<Bssrdf<'static>, Failure<'static>> {
        match self.content() {
            Content::Bssrdf(material) => Ok(material),
            other => Err(Failure::Family { found: other.family(), expected: "BSSRDF" }),
        }
    }

    /// Header and materials of a BTF.
    pub(crate) fn catalog(&self) -> Result<Catalog<'static>, Failure<'static>> {
        match self.content() {
            Content::NestedBtf(btf) => Ok(*btf.catalog()),
            Content::FactoredBtf(btf) => Ok(*btf.catalog()),
            other => Err(Failure::Family { found: other.family(), expected: "BTF" }),
        }
    }

    pub(crate) fn texels(&self) -> u32 {
        self.texels
    }

    pub(crate) fn expansion(&self) -> Option<&ExpandedBtf<'static>> {
        self.expansion.as_ref().map(|expansion| &expansion.btf)
    }
}

/// Checks bytes and makes a handle of them.
///
/// # Safety
/// `bytes` stay as they are until the handle is closed: `mapping`'s, or the caller's.
unsafe fn open(
    bytes: *const [u8],
    mapping: Option<Mapping>,
    path: Option<&[u8]>,
    file_out: *mut *mut SubsurfFile,
) -> Result<(), Failure<'_>> {
    // SAFETY: the caller's word, and nobody outlives the handle who borrows from it.
    let bytes: &'static [u8] = unsafe { &*bytes };
    let file = File::parse(bytes).map_err(|error| Failure::Read { path, error })?;
    let mut open = OpenFile { file, texels: 0, expansion: None, _mapping: mapping };
    open.texels = open.catalog().map_or(0, |catalog| catalog.texels());
    let handle = Handle::create(open)?.as_ptr().cast::<SubsurfFile>();
    // SAFETY: the pointer was not null.
    unsafe { border::write("file_out", file_out, handle) }
}

/// Opens a file whose bytes are in memory: checks all of it, copies none.
///
/// `bytes`: `length` bytes of any alignment; what follows the file is ignored. `*file_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT` (null; more bytes than memory can have), `INVALID_FILE`, `OUT_OF_MEMORY` (a handle takes about 2 kB).
/// Ownership: the bytes stay the caller's, who keeps them as they are until the file is closed.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_open_memory(
    bytes: *const c_void,
    length: usize,
    file_out: *mut *mut SubsurfFile,
) -> SubsurfStatus {
    let open = || {
        border::not_null("bytes", bytes)?;
        border::not_null("file_out", file_out)?;
        border::in_memory("length", length)?;
        let bytes = core::ptr::slice_from_raw_parts(bytes.cast::<u8>(), length);
        // SAFETY: the caller keeps the bytes.
        unsafe { open(bytes, None, None, file_out) }
    };
    status_of(open())
}

/// Opens a part of a file by its descriptor, such as an asset inside an APK: maps it, copies nothing.
///
/// `offset`: first byte, of any alignment; `length`: bytes, or `SUBSURF_TO_END`. On Android both come from
/// `AAsset_openFileDescriptor64` or `AssetFileDescriptor`, for an asset that is stored without compression.
/// `*file_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT` (null), `IO` (not a regular file, fewer bytes than asked for), `INVALID_FILE`, `OUT_OF_MEMORY`.
/// Ownership: the descriptor stays the caller's, who may close it at once. Who shortens the file while it is open ends the
/// process: replace files, do not rewrite them.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_open_fd(
    fd: c_int,
    offset: u64,
    length: u64,
    file_out: *mut *mut SubsurfFile,
) -> SubsurfStatus {
    let open = || {
        border::not_null("file_out", file_out)?;
        let length = (length != SUBSURF_TO_END).then_some(length);
        let mapping = Mapping::of_fd(fd, offset, length).map_err(|error| Failure::Map { path: None, error })?;
        let bytes: *const [u8] = mapping.bytes();
        // SAFETY: the handle keeps the mapping, whose bytes do not move with it.
        unsafe { open(bytes, Some(mapping), None, file_out) }
    };
    status_of(open())
}

/// Opens a file by its path: maps it, copies nothing.
///
/// `path`: zero-terminated; on Windows in UTF-8. `*file_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT` (null), `IO`, `INVALID_FILE`, `OUT_OF_MEMORY`; the text of `IO` and `INVALID_FILE` begins with the path.
/// Ownership: the path is not needed afterwards. Who shortens the file while it is open ends the process: replace files, do
/// not rewrite them.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_open_path(path: *const c_char, file_out: *mut *mut SubsurfFile) -> SubsurfStatus {
    let open = || {
        border::not_null("path", path)?;
        border::not_null("file_out", file_out)?;
        // SAFETY: not null, and so zero-terminated, the caller promises.
        let path = unsafe { CStr::from_ptr(path) };
        let name = Some(path.to_bytes());
        let mapping = Mapping::of_path(path).map_err(|error| Failure::Map { path: name, error })?;
        let bytes: *const [u8] = mapping.bytes();
        // SAFETY: the handle keeps the mapping, whose bytes do not move with it.
        unsafe { open(bytes, Some(mapping), name, file_out) }
    };
    status_of(open())
}

/// All bytes of an open file, as they are stored.
///
/// `*bytes_out`, `*length_out`: where they are and how many; what followed the file in memory is not part of it.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the bytes are the file's, or the caller's who opened them; valid until the file is closed.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_bytes(
    file: *const SubsurfFile,
    bytes_out: *mut *const c_void,
    length_out: *mut usize,
) -> SubsurfStatus {
    let bytes = || {
        // SAFETY: the caller's handle.
        let bytes = unsafe { SubsurfFile::of(file) }?.file().container().file();
        border::not_null("length_out", length_out)?;
        // SAFETY: both are the caller's.
        unsafe {
            border::write("bytes_out", bytes_out, bytes.as_ptr().cast())?;
            border::write("length_out", length_out, bytes.len())
        }
    };
    status_of(bytes())
}

/// Closes a file. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone, and so are pointers to planes of it, but for bytes that are the caller's.
/// Threads: any, once no other uses the file.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_file_close(file: *mut SubsurfFile) {
    // SAFETY: the caller's handle, which is given up.
    unsafe { Handle::<OpenFile>::close(file.cast()) };
}
